#include "io/read/read_scene.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "tests/support/analytic.h"
#include "tests/support/discontinuity_scenes.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

SoundScene load() { return make_sound(read_scene(test::data_file("table_and_chairs.obj")).scene); }

TEST(TableAndChairs, FileHasTheSceneOfTheTests) {
  const SoundScene read = load(), built = test::table_and_chairs_maker().sound();
  ASSERT_EQ(read.surfaces.size(), 72u);
  ASSERT_EQ(built.surfaces.size(), read.surfaces.size());
  for (std::size_t r = 0; r < read.surfaces.size(); ++r) {
    EXPECT_NEAR(area(read.surfaces[r]), area(built.surfaces[r]), 1e-9) << r;
    const PlaneFrame &a = read.surfaces[r].frame, &b = built.surfaces[r].frame;
    EXPECT_LT((a.normal - b.normal).norm(), 1e-9);
    for (std::size_t k = 0; k < built.surfaces[r].rings[0].size(); ++k)
      EXPECT_NEAR(a.height(b.to_space(built.surfaces[r].rings[0][k])), 0, 1e-9);
  }
}

TEST(TableAndChairs, LightIsThatOfItsRectangle) {
  const DirectLightIndex index(load());
  ASSERT_EQ(index.emitters().size(), 1u);
  const Vec3 up = Vec3::UnitZ();
  for (const Vec3& p : {Vec3(1.8, 1.7, 0), Vec3(0.1, 0.05, 0.75)}) {
    const double want = test::point_parallel_rectangle(-0.4 - p.x(), 0.4 - p.x(), -0.3 - p.y(),
                                                       0.35 - p.y(), 2.4 - p.z());
    EXPECT_NEAR(index.factor({p, up}, index.emitters()[0]).visible, want, 1e-14) << p.transpose();
  }
  EXPECT_EQ(index.factor({{0.3, 0.1, 0}, up}, index.emitters()[0]).region, Region::umbra);
}

}  // namespace
}  // namespace halfshade
