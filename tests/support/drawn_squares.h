#pragma once

#include "io/picture/picture.h"

#include <array>
#include <utility>

/// Meshes of a few squares, and a camera that looks at them.
namespace halfshade::test {

/// Adds a square parallel to the xy plane that looks towards +z, or away from it.
inline void add_square(ShadedMesh& mesh, const Vec3& centre, double half, const Rgb& value,
                       bool emits = false, bool away = false) {
  const int p = static_cast<int>(mesh.points.size());
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    mesh.points.push_back(centre + half * Vec3(x, y, 0));
    mesh.point_value.push_back(value);
  }
  for (std::array<int, 3> t : {std::array{p, p + 1, p + 2}, {p, p + 2, p + 3}}) {
    if (away) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
    mesh.triangle_value.push_back(value);
    mesh.emits.push_back(emits);
  }
}

/// Looks along −z from z = 1; the unit square [−1, 1]² in z = 0 fills the picture exactly.
inline Camera facing() {
  Camera camera;
  camera.position = {0, 0, 1};
  camera.vertical_fov = 90;
  return camera;
}

inline PictureOptions picture_options(int width, int height, int samples = 4) {
  PictureOptions result;
  result.width = width;
  result.height = height;
  result.samples = samples;
  return result;
}

using Pixel = std::array<int, 3>;

inline Pixel pixel_of(const Picture& picture, int column, int row) {
  const auto i = static_cast<std::size_t>(3 * (row * picture.width + column));
  return {picture.pixels.at(i), picture.pixels.at(i + 1), picture.pixels.at(i + 2)};
}

/// Of linear 0.015: 255·(1.055·0.015^(1/2.4) − 0.055).
inline constexpr Pixel picture_background = {33, 33, 33};

}  // namespace halfshade::test
