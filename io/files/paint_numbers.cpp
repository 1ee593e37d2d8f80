#include "io/files/paint_numbers.h"

#include "io/files/srgb.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace halfshade::detail {
namespace {

/// Null if the numbers do not fit together.
std::shared_ptr<const Texture> to_texture(int width, int height, const std::vector<int>& codes) {
  if (width < 1 || height < 1 ||
      codes.size() != 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    return nullptr;
  std::vector<Eigen::Array3f> texels;
  for (std::size_t k = 0; k < codes.size(); k += 3) {
    Rgb texel;
    for (std::size_t c = 0; c < 3; ++c)
      texel[static_cast<Eigen::Index>(c)] = from_srgb(std::clamp(codes[k + c], 0, 255) / 255.);
    texels.push_back(texel.cast<float>().max(0).min(1));
  }
  return std::make_shared<const Texture>(make_texture("", width, height, std::move(texels)));
}

}  // namespace

PaintNumbers to_numbers(const std::vector<PaintOn>& paints) {
  PaintNumbers numbers;
  std::vector<const Texture*> known;
  for (const auto& [paint, most] : paints) {
    const auto found = std::find(known.begin(), known.end(), paint.texture.get());
    numbers.paints.push_back(static_cast<double>(found - known.begin()));
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 3; ++column) numbers.paints.push_back(paint.along(row, column));
    numbers.paints.insert(numbers.paints.end(), {paint.from.x(), paint.from.y()});
    numbers.paints.insert(numbers.paints.end(), {most[0], most[1], most[2]});
    if (found != known.end()) continue;
    known.push_back(paint.texture.get());
    const TextureLevel& level = paint.texture->levels.front();
    numbers.sizes.insert(numbers.sizes.end(), {level.width, level.height});
    std::vector<int>& codes = numbers.textures.emplace_back();
    for (const auto& texel : level.texels)
      for (int c = 0; c < 3; ++c)
        codes.push_back(
            static_cast<int>(std::lround(255 * to_srgb(static_cast<double>(texel[c])))));
  }
  return numbers;
}

std::vector<PaintOn> to_paints(const PaintNumbers& numbers) {
  std::vector<std::shared_ptr<const Texture>> textures;
  if (numbers.sizes.size() != 2 * numbers.textures.size()) return {};
  for (std::size_t k = 0; k < numbers.textures.size(); ++k) {
    textures.push_back(
        to_texture(numbers.sizes[2 * k], numbers.sizes[2 * k + 1], numbers.textures[k]));
    if (!textures.back()) return {};
  }
  std::vector<PaintOn> paints;
  constexpr std::size_t step = paint_components;
  for (std::size_t k = 0; k + step <= numbers.paints.size(); k += step) {
    const double* row = numbers.paints.data() + k;
    if (!std::all_of(row, row + step, [](double x) { return std::isfinite(x); }) || row[0] < 0 ||
        row[0] >= static_cast<double>(textures.size()))
      return {};
    PaintOn& paint = paints.emplace_back();
    paint.paint.texture = textures[static_cast<std::size_t>(row[0])];
    paint.paint.along << row[1], row[2], row[3], row[4], row[5], row[6];
    paint.paint.from = {row[7], row[8]};
    paint.most = {row[9], row[10], row[11]};
  }
  return paints;
}

}  // namespace halfshade::detail
