#pragma once

#include "meshing/core/types.h"

#include <memory>
#include <string>
#include <vector>

namespace halfshade {

/// A picture, or a smaller copy of it: rows from the lower left.
struct TextureLevel {
  int width = 0, height = 0;  ///< texels
  std::vector<Eigen::Array3f> texels;
};

/// A picture whose values, linear in light and in [0, 1], multiply a reflectance.
struct Texture {
  std::string name;
  std::vector<TextureLevel> levels;  ///< each half as wide and high as the one before, to a texel
};

/// How a picture lies on a plane, which it covers again and again.
struct Paint {
  std::shared_ptr<const Texture> texture;
  /// A point p of the plane is at along · p + from of the picture, whose corners lie at 0 and 1.
  Eigen::Matrix<double, 2, 3> along = Eigen::Matrix<double, 2, 3>::Zero();
  Vec2 from = Vec2::Zero();

  Vec2 place(const Vec3& p) const { return along * p + from; }
};

/// Makes the levels, whose means are that of the picture. Throws Error(contract) unless there are
/// width · height > 0 texels in [0, 1].
Texture make_texture(std::string name, int width, int height, std::vector<Eigen::Array3f> texels);

/// The value at a place of the picture: linear between the centres of texels.
Rgb value_at(const TextureLevel& level, const Vec2& place);

/// The same of the picture itself at a point of the plane.
Rgb colour_at(const Paint& paint, const Vec3& position);

/// True if its channels are equal everywhere.
bool is_grey(const Texture& texture);

}  // namespace halfshade
