#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

using test::Random;

/// A square light at z = 2 over a box that lies as chance has it.
Scene tilted_box(Random& random) {
  Scene scene;
  const int dark = test::add_material(scene, 0, 0), light = test::add_material(scene, 0, 1);
  test::add_polygon(scene, {{-.5, .5, 2}, {.5, .5, 2}, {.5, -.5, 2}, {-.5, -.5, 2}}, light);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(random(0, 6), random.direction()).toRotationMatrix();
  const Vec3 centre(random(-0.5, 0.5), random(-0.5, 0.5), random(0.7, 1.3));
  const Vec3 half(random(0.1, 0.3), random(0.1, 0.3), random(0.1, 0.3));
  for (std::vector<Vec3> face : test::box_faces(-half, half, false)) {
    for (Vec3& p : face) p = centre + turn * p;
    test::add_polygon(scene, face, dark);
  }
  return scene;
}

/// A point of a surface's plane, at a small share of its size from one of its edges.
Vec3 near_an_edge(const Surface& surface, Random& random) {
  const Ring& ring = surface.rings.front();
  const auto k = static_cast<std::size_t>(random(0, static_cast<double>(ring.size()) - 1e-9));
  const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()], &c = ring[(k + 2) % ring.size()];
  const double inwards = std::pow(10, random(-5, -1)), along = random(0.02, 0.98);
  return surface.frame.to_space(a + along * (b - a) + inwards * (c - b));
}

// Seen from a point that rounding has put below the plane of its own surface, that surface's near
// edges rise above its horizon by more than it is raised. Their arcs run along the horizon, and
// where both cross is all but undecided: the boundary of what is seen must not have a gap there.
TEST(DirectLightNearEdges, DoesNotFeelTheRoundingOfThePoint) {
  Random random(5);
  std::vector<double> off;
  for (int box = 0; box < 60; ++box) {
    const SoundScene scene = make_sound(tilted_box(random));
    const DirectLightIndex index(scene);
    std::vector<SurfacePoint> on, above;
    for (int k = 0; k < 3000; ++k) {
      const auto s = 1 + static_cast<std::size_t>(
                             random(0, static_cast<double>(scene.surfaces.size()) - 1 - 1e-9));
      const Surface& surface = scene.surfaces[s];
      const Vec3 p = near_an_edge(surface, random), n = surface.frame.normal;
      on.push_back({p, n});
      above.push_back({p + 1e-10 * n, n});
    }
    const auto light = index.irradiance(on), expected = index.irradiance(above);
    for (std::size_t k = 0; k < on.size(); ++k)
      off.push_back((light[k].irradiance - expected[k].irradiance).abs().maxCoeff());
  }
  EXPECT_LE(*std::max_element(off.begin(), off.end()), 1e-9);
}

}  // namespace
}  // namespace halfshade
