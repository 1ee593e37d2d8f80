#pragma once

#include "tests/support/random.h"
#include "tests/support/scenes.h"

/// Scenes of triangles that nobody modelled: they cut through each other, and all have corners of
/// their own. The first emits 100 W/m² and is black, the others reflect half.
namespace halfshade::test {

/// `corner` makes each of the three corners of each triangle in turn.
template <class Corner>
Scene triangle_soup(int count, const Corner& corner) {
  Scene scene;
  scene.source = "soup.obj";
  const int lamp = add_material(scene, 0, 100), wall = add_material(scene, 0.5, 0);
  for (int k = 0; k < count; ++k) {
    const Vec3 a = corner(), b = corner(), c = corner();
    add_polygon(scene, {a, b, c}, k == 0 ? lamp : wall);
  }
  return scene;
}

/// With corners anywhere in the unit cube.
inline Scene unit_soup(int count, std::uint64_t seed) {
  Random random(seed);
  return triangle_soup(count, [&] { return random.point(0, 1); });
}

/// With whole numbers from 0 to `cells` for coordinates: many share corners, edges and planes.
inline Scene grid_soup(int count, int cells, std::uint64_t seed) {
  Random random(seed);
  const auto whole = [&] { return static_cast<double>(random.integer(0, cells)); };
  return triangle_soup(count, [&] {
    const double x = whole(), y = whole(), z = whole();
    return Vec3(x, y, z);
  });
}

}  // namespace halfshade::test
