#include "meshing/visible_part.h"

#include "tests/meshing/visible_part_oracle.h"
#include "tests/support/receivers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace halfshade {
namespace {

using test::add_box;
using test::add_receiver;
using test::facing_down;
using test::Polygon;

const Vec3 up = Vec3::UnitZ();

VisiblePart find(const SoundScene& scene, const Vec3& point, const Vec3& normal = up,
                 int emitter = 0) {
  const OpaqueScene opaque(scene);
  VisiblePartFinder finder(opaque);
  VisiblePart part;
  finder.find(point, normal, emitter, part);
  return part;
}

double factor(const VisiblePart& part, const Vec3& point, const Vec3& normal = up) {
  return test::lambert(part.pieces, point, normal);
}

TEST(VisiblePart, SquareOverSquareHasThePublishedFactors) {
  const SoundScene scene = test::square_over_square();
  const std::vector<std::pair<Vec3, double>> expected = {{{.5, 0, 0}, 0.018916915317},
                                                         {{.75, .3, 0}, 0.033762803811},
                                                         {{1.25, 0, 0}, 0.040681704379},
                                                         {{1.5, .2, 0}, 0.032271304623}};
  for (const auto& [point, value] : expected)
    EXPECT_NEAR(factor(find(scene, point), point), value, 1e-12) << point.transpose();
}

TEST(VisiblePart, SquareOverSquareHasItsUmbraAndLitRegionsWhereSimilarTrianglesPutThem) {
  const SoundScene scene = test::square_over_square();
  for (const double x : {-.2499999, -.1, 0., .0625, .2499999})
    for (const double y : {-.2499999, 0., .125}) {
      EXPECT_EQ(find(scene, {x, y, 0}).region, Region::umbra);
      EXPECT_TRUE(find(scene, {x, y, 0}).pieces.empty());
    }
  for (const double x : {1.2500001, 1.5, -1.7}) {
    EXPECT_EQ(find(scene, {x, .3, 0}).region, Region::lit);
    EXPECT_EQ(find(scene, {.3, x, 0}).region, Region::lit);
  }
  for (const double x : {.2500001, -.7, 1.2499999})
    EXPECT_EQ(find(scene, {x, .1, 0}).region, Region::penumbra);
}

}  // namespace
}  // namespace halfshade
