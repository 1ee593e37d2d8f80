#pragma once

#include "io/read/face_cut.h"
#include "io/read/light_receivers.h"

namespace halfshade::reading {

/// What the light of one lamp is off if even pieces shine instead of a picture.
class LampError {
 public:
  /// `grid` holds exitances. Of the receivers, those count that the lamp shines on most.
  LampError(const PictureGrid& grid, const Paint& paint, std::span<const Vec3> polygon,
            bool two_sided, const LightReceivers& receivers);

  /// An estimate of ∫ (what irradiance is off)² over all surfaces and channels. Of two parts: what
  /// cells of the grid, one by one, send more or less than the pieces do, as if nothing were in
  /// between, which tells what is felt near by and what cancels far away; and what cancels no
  /// longer where borders of shadows cut pieces in two.
  double squared(const std::vector<PicturePiece>& pieces) const;

 private:
  struct Place {
    LightReceiver receiver;
    Vec2 foot;  ///< in the lamp's frame
    double height;
    double across_e1, across_e2, along;  ///< the receiver's normal in that frame
  };

  void look_into_cells();

  const PictureGrid& grid_;
  std::vector<Rgb> value_;      ///< of cells, for light as if exitance rose across them
  std::vector<double> rising_;  ///< squared deviation within each, mean
  std::vector<Vec2> middle_;    ///< of each cell; empty: the picture is a line or a point there
  std::vector<Place> places_;
  double missed_ = 1;  ///< by how much places_ are too few
};

}  // namespace halfshade::reading
