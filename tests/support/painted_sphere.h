#pragma once

#include "tests/support/scenes.h"

#include <array>
#include <utility>
#include <vector>

namespace halfshade::test {

/// A sphere of 8 · 4^halvings flat triangles that looks inwards, painted: exitance 1 + z²,
/// reflectance .5 + .4 z. Irradiance is mean(E) / (1 − mean(ρ)) = 8/3 all over, up to flatness.
inline Scene painted_sphere(int halvings) {
  std::vector<std::array<Vec3, 3>> faces;
  for (const double x : {-1., 1.})
    for (const double y : {-1., 1.})
      for (const double z : {-1., 1.}) {
        faces.push_back({Vec3(x, 0, 0), Vec3(0, y, 0), Vec3(0, 0, z)});
        if (x * y * z > 0) std::swap(faces.back()[0], faces.back()[1]);
      }
  for (int h = 0; h < halvings; ++h) {
    std::vector<std::array<Vec3, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      for (const auto& face : {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
        finer.push_back(face);
    }
    faces = finer;
  }
  Scene scene;
  for (const auto& [a, b, c] : faces) {
    const double z = (a + b + c).normalized().z();
    add_polygon(scene, {a, b, c}, add_material(scene, 0.5 + 0.4 * z, 1 + z * z));
  }
  return scene;
}

}  // namespace halfshade::test
