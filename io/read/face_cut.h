#pragma once

#include "io/read/picture_grid.h"

#include <algorithm>

namespace halfshade::reading {

/// What a picture may differ by from its pieces' means, root mean square, over the face's mean,
/// where nothing is known of what it shines on.
inline constexpr double even_enough = 0.02;
/// That one face is cut into, likewise.
inline constexpr std::size_t few_pieces = 64;

/// Values over an area.
struct PictureSum {
  double area = 0;
  Rgb value = Rgb::Zero();  ///< times area
  double square = 0;        ///< of all channels, times area

  void add(double more, const Rgb& of) {
    area += more;
    value += more * of;
    square += more * of.square().sum();
  }
  PictureSum& operator+=(const PictureSum& other) {
    area += other.area;
    value += other.value;
    square += other.square;
    return *this;
  }
  Rgb mean() const { return value / area; }
  double explained() const { return area > 0 ? value.square().sum() / area : 0; }
  /// Squares of differences from the mean.
  double deviation() const { return std::max(0., square - explained()); }
};

/// A block of a grid, and where it is best cut.
struct PicturePiece {
  GridBlock block;
  PictureSum sum;
  std::size_t axis = 0;
  int line = -1;    ///< −1: it cannot be cut
  double gain = 0;  ///< squared deviation that it takes away
};

/// Blocks that cover a grid, more and more of them.
class FaceCut {
 public:
  explicit FaceCut(const PictureGrid& grid);

  const std::vector<PicturePiece>& pieces() const { return pieces_; }
  /// Of all of them.
  PictureSum sum() const;
  double deviation() const;

  /// Cuts until the picture is even enough, or there are a few; what has most deviation first.
  void cut_evenly();
  /// Cuts until there are so many pieces; first what far surfaces feel most, which is the deviation
  /// times the area. False if no more than there were.
  bool cut_further(std::size_t count);

 private:
  void cut(std::vector<PicturePiece>::iterator piece);

  const PictureGrid& grid_;
  std::vector<PicturePiece> pieces_;
};

}  // namespace halfshade::reading
