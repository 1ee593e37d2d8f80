#pragma once

#include "tests/support/balls.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace halfshade::test {

/// The side of an upright cylinder, looking outwards, and its ends.
struct Cylinder {
  Vec3 foot;
  double radius, height;
  int faces;
  bool has_bottom = false, has_top = true;
};

inline void add_cylinder(Scene& scene, const Cylinder& cylinder, int material) {
  const auto corner = [&](int k, double z) -> Vec3 {
    const int n = cylinder.faces;
    const double angle = 2 * std::numbers::pi * ((k + n) % n) / n;
    return cylinder.foot +
           Vec3(cylinder.radius * std::cos(angle), cylinder.radius * std::sin(angle), z);
  };
  std::vector<Vec3> bottom, top;
  for (int k = 0; k < cylinder.faces; ++k) {
    bottom.push_back(corner(-k, 0));
    top.push_back(corner(k, cylinder.height));
    add_polygon(scene,
                {corner(k, 0), corner(k + 1, 0), corner(k + 1, cylinder.height),
                 corner(k, cylinder.height)},
                material);
  }
  if (cylinder.has_bottom) add_polygon(scene, bottom, material);
  if (cylinder.has_top) add_polygon(scene, top, material);
}

/// A room in which cylinders stand on the floor, one hovers, and a ball and a box hang between
/// them, before a sheet; another sheet pierces the box. Each has a material of its own; walls are
/// the first.
inline Scene room_with_round_things(int faces) {
  Scene scene;
  const int walls = add_material(scene, 0.5, 0);
  for (const auto& face : box_faces(Vec3::Zero(), {6, 4, 3}, true)) add_polygon(scene, face, walls);
  const auto next = [&] { return add_material(scene, 0.5, 0); };
  add_cylinder(scene, {{1, 1.5, 0}, .5, 1.7, faces}, next());
  add_cylinder(scene, {{2.6, 2, 0}, .4, 2, faces}, next());
  add_cylinder(scene, {{4.6, 2.3, .7}, .4, 1.6, faces, true}, next());
  const int ball = next();
  for (const auto& [a, b, c] : icosphere({3.6, 1, 1.4}, .6, 1)) add_polygon(scene, {a, b, c}, ball);
  const int box = next();
  for (const auto& face : box_faces({1.5, 2.6, .8}, {2, 3.1, 1.9}, false))
    add_polygon(scene, face, box);
  add_polygon(scene, {{3.4, 2.4, .3}, {3.6, 3.4, .4}, {3.5, 3.4, 2}, {3.3, 2.4, 1.9}}, next());
  add_polygon(scene, {{1.2, 2.7, .9}, {2.3, 2.7, 1}, {2.3, 2.9, 1.8}, {1.2, 2.9, 1.7}}, next());
  return scene;
}

}  // namespace halfshade::test
