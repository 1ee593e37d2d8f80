#include "meshing/repair/common_area.h"

#include "tests/support/repair_scenes.h"

#include <Eigen/Geometry>

namespace halfshade {
namespace {

using test::rectangle;

/// Of two polygons given in a plane, wherever that is.
bool lie_over(std::vector<Vec3> a, std::vector<Vec3> b) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  for (Vec3& p : a) p = turn * p;
  for (Vec3& p : b) p = turn * p;
  const LocalTolerance tolerance = tolerance_of(joint_scale(scale_of(a), scale_of(b)));
  const bool found = have_common_area(a, b, fit_plane(a), tolerance);
  EXPECT_EQ(have_common_area(b, test::reversed(a), fit_plane(b), tolerance), found);
  return found;
}

TEST(CommonArea, IsThatOfPolygonsOverEachOther) {
  EXPECT_TRUE(lie_over(rectangle(0, 0, 1, 1), rectangle(0, 0, 1, 1, 1e-6)));
  EXPECT_TRUE(lie_over(rectangle(0, 0, 4, 4), rectangle(1, 1, 2, 2)));
  // Borders on each other, so that no corner lies inside the other and no sides cross.
  EXPECT_TRUE(lie_over(rectangle(0, 0, 2, 1), rectangle(1, 0, 3, 1)));
  EXPECT_TRUE(lie_over(rectangle(0, 1, 3, 2), rectangle(1, 0, 2, 3)));
}

TEST(CommonArea, IsNotThatOfNeighbours) {
  EXPECT_FALSE(lie_over(rectangle(0, 0, 1, 1), rectangle(1, 0, 2, 1)));
  EXPECT_FALSE(lie_over(rectangle(0, 0, 1, 1), rectangle(1 - 3e-7, 0, 2, 1)));
  EXPECT_FALSE(lie_over(rectangle(0, 0, 1, 1), rectangle(3, 0, 4, 1)));
  // In the corner of an L, whose box it lies in.
  EXPECT_FALSE(lie_over({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}},
                        rectangle(1, 1, 2, 2)));
}

}  // namespace
}  // namespace halfshade
