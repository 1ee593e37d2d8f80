#include "solver/reflected/leaving_cells.h"

#include "meshing/repair/repair.h"
#include "solver/elements/element_field.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

Rgb slope(int /*root*/, const Vec3& p) { return Rgb(1 + p.x(), 2 - p.y(), 0.5 * p.z()); }

ReflectingScene long_room() { return make_reflecting_scene(make_sound(test::room({3, 1, 1}, {}))); }

TEST(LeavingCells, EachHoldsItsPlacesAndTheyCoverTheirRoots) {
  const ReflectingScene scene = long_room();
  const LeavingCells cells(scene, {}, 500, slope);
  test::Random random(1);
  for (int r = 0; r < scene.roots.count(); ++r) {
    double area = 0;
    for (int c = cells.first(r); c < cells.first(r + 1); ++c) {
      const auto corners = cells.corners(r, c);
      const TrianglePlace a = corners[1] - corners[0], b = corners[2] - corners[0];
      area += std::abs(a.x() * b.y() - a.y() * b.x());
      for (int k = 0; k < 10; ++k) {
        // Not where rounding has to choose.
        const TrianglePlace inside = 0.999 * place_in(corners, random(0, 1), random(0, 1)) +
                                     0.001 / 3 * (corners[0] + corners[1] + corners[2]);
        EXPECT_EQ(cells.find(r, inside), c);
      }
    }
    EXPECT_NEAR(area, 1, 1e-12) << "of the unit triangle's, twice";
  }
  EXPECT_NEAR(cells.first(scene.roots.count()), 500, 100);
}

TEST(LeavingCells, AreOfOneSizeAndAtLeastOneARoot) {
  const ReflectingScene scene = long_room();
  const LeavingCells one(scene, {}, 1, slope);
  EXPECT_EQ(one.first(scene.roots.count()), scene.roots.count());
  EXPECT_TRUE(LeavingCells().empty());
  const LeavingCells cells(scene, {}, 2000, slope);
  for (int r = 0; r < scene.roots.count(); ++r) {
    const double area = scene.roots.area[at(r)] / (cells.first(r + 1) - cells.first(r));
    EXPECT_NEAR(area, 14. / 2000, 0.2 * 14 / 2000);
    const double longest = std::sqrt(5 * area);  // about that of a right triangle
    EXPECT_FALSE(cells.is_far(r, longest * longest));
    EXPECT_TRUE(cells.is_far(r, 64 * longest * longest));
  }
}

TEST(LeavingCells, MeansAreThoseOfWhatLeaves) {
  const ReflectingScene scene = long_room();
  const LeavingCells cells(scene, {}, 2000, slope);
  Rgb sum = Rgb::Zero(), expected = Rgb::Zero();
  for (int r = 0; r < scene.roots.count(); ++r) {
    const std::array<Vec3, 3> triangle = scene.roots.triangle(r);
    const double area = scene.roots.area[at(r)];
    expected += area * slope(r, (triangle[0] + triangle[1] + triangle[2]) / 3);
    for (int c = cells.first(r); c < cells.first(r + 1); ++c) {
      sum += area / (cells.first(r + 1) - cells.first(r)) * cells.mean(c);
      const auto corners = cells.corners(r, c);
      const Rgb middle = slope(r, position(triangle, (corners[0] + corners[1] + corners[2]) / 3));
      EXPECT_LT((cells.mean(c) - middle).abs().maxCoeff(), 0.15);
    }
  }
  EXPECT_LT(((sum - expected) / expected).abs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace halfshade
