#include "solver/reflected/triangle_forest.h"

#include "meshing/patches/patch_mesh.h"
#include "solver/elements/element_field.h"
#include "tests/support/element_points.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(TriangleForest, FindsTheLeafThatHoldsAPoint) {
  const SoundScene scene = test::s1();
  PlanarMeshOptions options;
  options.max_length = 0.8;
  const ElementTable roots = PatchMesh(scene, options).elements();
  TriangleForest forest(roots);
  test::Random random(5);
  for (int i = 0; i < 500; ++i) forest.bisect(random.below(forest.count()));
  double area = 0;
  for (int t = 0; t < forest.count(); ++t) area += forest.is_leaf(t) ? forest.area(t) : 0;
  double expected = 0;
  for (const double a : roots.area) expected += a;
  EXPECT_NEAR(area, expected, 1e-12);
  for (const auto& [surface, point] : test::spread_points(roots, 300, random)) {
    const ForestPlace leaf = forest.leaf_at(surface, point.position);
    ASSERT_GE(leaf.triangle, 0);
    EXPECT_TRUE(forest.is_leaf(leaf.triangle));
    EXPECT_EQ(roots.surface[at(forest.root(leaf.triangle))], surface);
    EXPECT_GE(leaf.place.minCoeff(), -1e-12);
    EXPECT_LE(leaf.place.sum(), 1 + 1e-12);
    EXPECT_LT((position(forest.corners(leaf.triangle), leaf.place) - point.position).norm(), 1e-12);
  }
  EXPECT_LT(forest.leaf_at(99, Vec3::Zero()).triangle, 0);
}

TEST(TriangleForest, TakesPointsJustOutsideToTheNearestLeaf) {
  const SoundScene scene = test::s1();
  TriangleForest forest(PatchMesh(scene, PlanarMeshOptions{}).elements());
  const ForestPlace leaf = forest.leaf_at(0, {0.5 + 1e-13, 0.1, 2});
  ASSERT_GE(leaf.triangle, 0);
  EXPECT_LT((position(forest.corners(leaf.triangle), leaf.place) - Vec3(0.5, 0.1, 2)).norm(), 1e-9);
}

}  // namespace
}  // namespace halfshade
