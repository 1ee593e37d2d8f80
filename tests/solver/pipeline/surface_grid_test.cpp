#include "solver/pipeline/surface_grid.h"

#include "tests/support/expect_error.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// A slanted square ring of side 4 with a hole of side 2, in group 0.
SoundScene ring() {
  SoundScene scene = test::empty_sound_scene(5);
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  const auto square = [&](double h, bool hole) {
    std::vector<Vec3> p = {{-h, -h, 1}, {h, -h, 1}, {h, h, 1}, {-h, h, 1}};
    if (hole) std::reverse(p.begin(), p.end());
    for (Vec3& v : p) v = turn * v;
    return p;
  };
  test::add_surface(scene, {square(2, false), square(1, true)}, 0);
  return scene;
}

TEST(SurfaceGrid, CoversThePolygonAndLeavesOutItsHole) {
  const SoundScene scene = ring();
  const auto points = surface_grid(scene, "all", 0.1);
  // The frame may be turned in the plane, hence about 12 / 0.1² points.
  EXPECT_NEAR(static_cast<double>(points.size()), 1200, 60);
  const PlaneFrame& frame = scene.surfaces[0].frame;
  double nearest = 1e9;
  for (const SurfacePoint& p : points) {
    EXPECT_NEAR(frame.height(p.position), 0, 1e-14);
    EXPECT_EQ(p.normal, frame.normal);
    nearest = std::min(nearest, (p.position - frame.origin).norm());
    if (&p != &points[0]) {
      EXPECT_GT((p.position - points[0].position).norm(), 0.1 - 1e-12);
    }
  }
  EXPECT_GE(nearest, 1);
}

TEST(SurfaceGrid, PutsOnePointOnWhatIsSmallerThanItsSpacing) {
  const SoundScene scene = test::s1();
  EXPECT_EQ(surface_grid(scene, "all", 100).size(), 3u) << "one a surface";
}

TEST(SurfaceGrid, RefusesWhatItCannotDo) {
  const SoundScene scene = ring();
  test::expect_error([&] { surface_grid(scene, "none", 1); }, ErrorCode::usage, {"'none'", "all"});
  test::expect_error([&] { surface_grid(scene, "all", 0); }, ErrorCode::contract, {"0"});
  test::expect_error([&] { surface_grid(scene, "all", std::nan("")); }, ErrorCode::contract,
                     {"nan"});
  test::expect_error([&] { surface_grid(scene, "all", 1e-5); }, ErrorCode::too_large, {"1e-05"});
  test::expect_error([&] { surface_grid(scene, "all", 100); }, ErrorCode::usage, {"no point"});
}

}  // namespace
}  // namespace halfshade
