#pragma once

#include "meshing/core/sound_scene.h"
#include "tests/support/mesh_invariants.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

/// Small scenes for the tests of the repair, and what they count.
namespace halfshade::test {

inline std::vector<Vec3> rectangle(double x0, double y0, double x1, double y1, double z = 0) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

inline std::vector<Vec3> reversed(std::vector<Vec3> polygon) {
  std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

// Several polygons, materials 0 (grey), 1 (another grey), 2 (light), 3 (two-sided).
inline Scene scene_of(const std::vector<std::pair<std::vector<Vec3>, int>>& polygons) {
  Scene scene;
  scene.source = "test.obj";
  add_material(scene, 0.5, 0);
  add_material(scene, 0.3, 0);
  add_material(scene, 0, 1);
  scene.materials[static_cast<std::size_t>(add_material(scene, 0.5, 0))].two_sided = true;
  for (const auto& [polygon, material] : polygons) add_polygon(scene, polygon, material);
  return scene;
}

inline int count(const SoundScene& scene, Repair::Kind kind) {
  return static_cast<int>(std::count_if(scene.repairs.begin(), scene.repairs.end(),
                                        [&](const Repair& r) { return r.kind == kind; }));
}

inline const Repair& only(const SoundScene& scene, Repair::Kind kind) {
  EXPECT_EQ(count(scene, kind), 1);
  return *std::find_if(scene.repairs.begin(), scene.repairs.end(),
                       [&](const Repair& r) { return r.kind == kind; });
}

inline double total_area(const SoundScene& scene) {
  double sum = 0;
  for (const Surface& surface : scene.surfaces) sum += area(surface);
  return sum;
}

inline double contact_length(const SoundScene& scene) {
  double sum = 0;
  for (const Surface& surface : scene.surfaces) sum += test::length_of(surface.contacts);
  return sum;
}

// What every sound scene fulfils.
inline void expect_surfaces_sound(const SoundScene& scene) {
  for (const Surface& surface : scene.surfaces) {
    ASSERT_FALSE(surface.rings.empty());
    EXPECT_GT(test::signed_area(surface.rings[0]), 0);
    for (std::size_t k = 1; k < surface.rings.size(); ++k)
      EXPECT_LT(test::signed_area(surface.rings[k]), 0);
    EXPECT_EQ(surface.faces.size(), surface.face_rings.size());
    EXPECT_FALSE(surface.faces.empty());
    EXPECT_NEAR(surface.frame.e1.cross(surface.frame.e2).dot(surface.frame.normal), 1, 1e-14);
    // All that is left of a surface may be a thin rim around a hole: a small difference.
    double of_rings = 0;
    for (const Ring& ring : surface.rings) of_rings += std::abs(test::signed_area(ring));
    EXPECT_NEAR(area(surface), test::area_of(surface.rings),
                1e-12 * area(surface) + 1e-15 * of_rings);
  }
}

}  // namespace halfshade::test
