#include "io/picture/picture.h"
#include "io/picture/text.h"
#include "meshing/core/error.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Of titles: as a share of the height, and at least and at most in pixels.
constexpr double title_share = 1 / 36., least_title = 9, most_title = 60;
const Rgb title_ink = Rgb::Constant(0.9), title_shade = Rgb::Constant(0.01);

void copy(const Picture& picture, int x, detail::LineCanvas& canvas) {
  for (int row = 0; row < picture.height; ++row)
    for (int column = 0; column < picture.width; ++column) {
      const std::size_t from = 3 * (at(row) * at(picture.width) + at(column));
      canvas.set(at(row) * at(canvas.width()) + at(x + column),
                 detail::decode_srgb(
                     {picture.pixels[from], picture.pixels[from + 1], picture.pixels[from + 2]}));
    }
}

/// Bright on a dark band that lets nothing of the picture disturb it.
void write_title(const std::string& title, int x, detail::LineCanvas& canvas) {
  const double size =
      std::clamp(std::round(title_share * canvas.height()), least_title, most_title);
  const int width = detail::text_width(title, size);
  if (width == 0) return;
  const int around = static_cast<int>(size / 2);
  canvas.fill(x, 0, width + 2 * around, static_cast<int>(1.8 * size), title_shade);
  draw_text(canvas, {static_cast<double>(x + around), 1.25 * size}, title,
            {size, detail::Anchor::start, title_ink});
}

}  // namespace

Picture beside(std::span<const Picture> pictures, std::span<const std::string> titles) {
  if (pictures.empty() || pictures.size() != titles.size())
    throw Error(ErrorCode::contract, "beside", "there must be a title for each picture");
  int width = 0;
  for (const Picture& picture : pictures) {
    if (picture.height != pictures[0].height)
      throw Error(ErrorCode::contract, "beside", "the pictures differ in height");
    width += picture.width;
  }
  detail::LineCanvas canvas(width, pictures[0].height, Rgb::Zero());
  int x = 0;
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    copy(pictures[k], x, canvas);
    write_title(titles[k], x, canvas);
    x += pictures[k].width;
  }
  return {width, pictures[0].height, pictures[0].exposure, canvas.bytes(), pictures[0].comment};
}

}  // namespace halfshade
