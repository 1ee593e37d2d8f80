#include "solver/direct/direct_light.h"
#include "tests/support/discontinuity_scenes.h"
#include "tests/support/signature_bisection.h"
#include "tests/support/visibility_oracle.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// The edges of a face's own neighbours lie exactly on its points' horizon. They hide nothing.
TEST(DirectLightNeighbours, FacesAreNotHiddenByThoseBesideThem) {
  test::SceneMaker posts;  // a post in a room whose light it stands under
  for (const auto& face : test::box_faces({-1.6, -1.4, 0}, {1.5, 1.7, 2.2}, true))
    posts.polygon(face);
  posts.down({-0.4, -0.5}, {0.5, 0.3}, 2.1, test::white_light)
      .standing_box({-0.9, -0.6, 0}, {-0.3, 0.2, 0.8});
  test::SceneMaker turned;
  turned.square_light(2.2).turned_box({0.2, -0.4, 0}, {0.7, 0.2, 0.9}, 0.5).floor();
  for (const SoundScene& scene : {posts.sound(), turned.sound()}) {
    const DirectLightIndex index(scene);
    const test::VisibilityOracle oracle(scene);
    const int light = index.emitters()[0];
    test::Random random(4);
    int lit = 0;
    for (int r = 0; r < static_cast<int>(scene.surfaces.size()); ++r)
      for (int i = 0; i < 150; ++i) {
        const Surface& surface = scene.surfaces[static_cast<std::size_t>(r)];
        const Vec3 point = surface.frame.to_space(test::random_point(surface, random));
        const PointFactor factor = index.factor({point, surface.frame.normal}, light);
        const auto want = oracle.form_factor(point, surface.frame.normal, light);
        EXPECT_NEAR(factor.visible, static_cast<double>(want.visible), 1e-13)
            << r << " " << point.transpose();
        EXPECT_NEAR(factor.unobstructed, static_cast<double>(want.unobstructed), 1e-13);
        if (want.visible > 1e-12L && want.visible == want.unobstructed) {
          ++lit;
          EXPECT_EQ(factor.region, Region::lit) << r << " " << point.transpose();
        }
      }
    EXPECT_GT(lit, 200);
  }
}

}  // namespace
}  // namespace halfshade
