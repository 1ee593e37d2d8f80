#pragma once

#include "meshing/core/scene.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <cstdint>
#include <vector>

/// Scenes at random, and changes of scenes that must not matter.
namespace halfshade::test {

/// A floor, one or two lights, and boxes and triangles between that may stand on the floor, touch
/// and cut each other.
inline Scene random_scene(std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  scene.groups = {"all"};
  const int grey = add_material(scene, 0.5, 0), light = add_material(scene, 0.2, 3);
  add_polygon(scene, {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, grey);
  for (int k = random.integer(1, 2); k > 0; --k) {
    const Vec3 at = random.in_box({-1.5, -1.5, 1.8}, {1, 1, 2.2});
    const double x = random(0.2, 0.8), y = random(0.2, 0.8), tilt = random(-0.1, 0.1);
    add_polygon(scene, {at, at + Vec3(0, y, 0), at + Vec3(x, y, tilt), at + Vec3(x, 0, tilt)},
                light);
  }
  for (int k = random.integer(1, 4); k > 0; --k) {
    const Vec3 low = random.in_box({-1.5, -1.5, 0}, {1, 1, 1});
    const Vec3 bottom(low.x(), low.y(), random.below(2) == 0 ? 0 : low.z());
    const Vec3 high = bottom + random.in_box({0.1, 0.1, 0.1}, {0.6, 0.6, 0.6});
    for (const auto& face : box_faces(bottom, high, false)) add_polygon(scene, face, grey);
  }
  for (int k = random.integer(0, 3); k > 0; --k) {
    const Vec3 at = random.in_box({-1.5, -1.5, 0.2}, {1, 1, 1.5});
    add_polygon(scene, {at, at + random.point(-0.7, 0.7), at + random.point(-0.7, 0.7)}, grey);
  }
  return scene;
}

/// Faces and vertices in the opposite order, faces from another corner.
inline Scene turned_round(Scene scene) {
  std::reverse(scene.faces.begin(), scene.faces.end());
  const int last = static_cast<int>(scene.vertices.size()) - 1;
  std::reverse(scene.vertices.begin(), scene.vertices.end());
  for (Face& face : scene.faces) {
    for (int& v : face.vertices) v = last - v;
    std::rotate(face.vertices.begin(), face.vertices.begin() + 1, face.vertices.end());
  }
  return scene;
}

/// With a black triangle, both lengths in sizes of the scene.
inline Scene with_black_triangle(Scene scene, double distance, double extent) {
  const double size = diagonal(scene);
  const int first = static_cast<int>(scene.vertices.size());
  const Vec3 from = scene.vertices.front() + distance * size * Vec3(0.6, -0.5, -0.62);
  for (const Vec3& way : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.3, 0.1, 1)})
    scene.vertices.push_back(from + extent * size * way);
  Material black;
  black.name = "elsewhere";
  black.rho.setZero();
  scene.materials.push_back(black);
  Face face;
  face.vertices = {first, first + 1, first + 2};
  face.material = static_cast<int>(scene.materials.size()) - 1;
  scene.faces.push_back(face);
  return scene;
}

}  // namespace halfshade::test
