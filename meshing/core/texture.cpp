#include "meshing/core/texture.h"

#include "meshing/core/error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halfshade {
namespace {

/// Lines of a picture made fewer: what each of the new ones covers of the old ones, on average.
/// `at_line(line, k)` is texel k of an old line.
template <class TexelOfLine>
void shrink(int lines, int fewer, int length, const TexelOfLine& at_line,
            std::vector<Eigen::Array3f>& out) {
  const double step = static_cast<double>(lines) / fewer;
  for (int i = 0; i < fewer; ++i)
    for (int k = 0; k < length; ++k) {
      Rgb sum = Rgb::Zero();
      const double first = i * step, end = std::min((i + 1) * step, static_cast<double>(lines));
      for (int line = static_cast<int>(first); line < end; ++line)
        sum += (std::min(end, line + 1.) - std::max(first, double{1} * line)) *
               at_line(line, k).template cast<double>();
      out.push_back((sum / (end - first)).cast<float>());
    }
}

TextureLevel half(const TextureLevel& level) {
  const int width = std::max(1, level.width / 2), height = std::max(1, level.height / 2);
  TextureLevel lower;  // fewer rows, and the result turned
  shrink(
      level.height, height, level.width,
      [&](int row, int k) { return level.texels[at(row * level.width + k)]; }, lower.texels);
  TextureLevel turned;
  shrink(
      level.width, width, height,
      [&](int column, int k) { return lower.texels[at(k * level.width + column)]; }, turned.texels);
  TextureLevel result{width, height, {}};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      result.texels.push_back(turned.texels[at(column * height + row)]);
  return result;
}

/// Texels of one copy on both sides of a place along one axis, and the share of the second: nothing
/// of the next copy shows along a border.
struct Between {
  int first, second;
  double share;
};

Between between(double place, int count) {
  const double turn = place - std::floor(place);
  const double along = turn * count - 0.5;
  const double below = std::floor(along);
  const int first = static_cast<int>(below);
  return {std::max(first, 0), std::min(first + 1, count - 1), along - below};
}

}  // namespace

Texture make_texture(std::string name, int width, int height, std::vector<Eigen::Array3f> texels) {
  if (width < 1 || height < 1 || texels.size() != at(width) * at(height) ||
      !std::all_of(texels.begin(), texels.end(),
                   [](const auto& t) { return (t >= 0 && t <= 1).all(); }))
    throw Error(ErrorCode::contract, "make_texture",
                "a picture needs width · height texels with values from 0 to 1");
  Texture texture;
  texture.name = std::move(name);
  texture.levels.push_back({width, height, std::move(texels)});
  while (texture.levels.back().texels.size() > 1)
    texture.levels.push_back(half(texture.levels.back()));
  return texture;
}

Rgb value_at(const TextureLevel& level, const Vec2& place) {
  const Between u = between(place.x(), level.width), v = between(place.y(), level.height);
  const auto texel = [&](int column, int row) {
    return Rgb(level.texels[at(row * level.width + column)].cast<double>());
  };
  const Rgb low = (1 - u.share) * texel(u.first, v.first) + u.share * texel(u.second, v.first);
  const Rgb high = (1 - u.share) * texel(u.first, v.second) + u.share * texel(u.second, v.second);
  return (1 - v.share) * low + v.share * high;
}

Rgb colour_at(const Paint& paint, const Vec3& position) {
  return value_at(paint.texture->levels.front(), paint.place(position));
}

bool is_grey(const Texture& texture) {
  const auto& texels = texture.levels.front().texels;
  return std::all_of(texels.begin(), texels.end(),
                     [](const auto& t) { return t[0] == t[1] && t[1] == t[2]; });
}

}  // namespace halfshade
