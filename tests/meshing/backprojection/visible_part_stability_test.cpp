#include "meshing/backprojection/visible_part.h"
#include "tests/support/allocations.h"
#include "tests/support/surfaces.h"
#include "tests/support/visible_part_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

// Signatures, determinism and memory.

namespace halfshade {
namespace {

using test::facing_down;
using test::find_visible;
using test::Random;

int cell(double x) { return x < -1.25 ? 0 : x < -.25 ? 1 : x < .25 ? 2 : x < 1.25 ? 3 : 4; }

TEST(VisiblePartSignature, IsConstantInACellAndDiffersBetweenCells) {
  // The discontinuity lines of a square under a square are |x|, |y| = 0.25 and 1.25.
  const SoundScene scene = test::square_over_square();
  std::map<std::pair<int, int>, std::set<std::uint64_t>> seen;
  Random random(1);
  for (int k = 0; k < 4000; ++k) {
    const Vec3 point(random(-1.9, 1.9), random(-1.9, 1.9), 0);
    const VisiblePart part = find_visible(scene, point);
    const bool is_lit = std::max(std::abs(point.x()), std::abs(point.y())) > 1.25;
    EXPECT_EQ(part.region == Region::lit, is_lit);
    seen[is_lit ? std::pair(-1, -1) : std::pair(cell(point.x()), cell(point.y()))].insert(
        part.signature);
  }
  ASSERT_EQ(seen.size(), 10u);
  std::set<std::uint64_t> all;
  for (const auto& [where, signatures] : seen) {
    EXPECT_EQ(signatures.size(), 1u) << where.first << " " << where.second;
    all.insert(signatures.begin(), signatures.end());
  }
  EXPECT_EQ(all.size(), 10u);
}

SoundScene sphere_scene(int levels) {
  SoundScene scene;
  test::add_lit_surface(scene, facing_down(-.5, .5, -.5, .5, 2), 1);
  test::add_sphere(scene, {.1, .05, 1}, .3, levels);
  test::finish(scene);
  return scene;
}

TEST(VisiblePartFinder, FindsTheSameInAnyOrderAndWithAnyFinder) {
  const SoundScene scene = sphere_scene(2);
  const OpaqueScene opaque(scene);
  VisiblePartFinder one(opaque), other(opaque);
  std::vector<Vec3> points;
  Random random(2);
  for (int k = 0; k < 50; ++k) points.emplace_back(random(-1, 1), random(-1, 1), 0);
  std::vector<VisiblePart> forward(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) one.find(points[k], Vec3::UnitZ(), 0, forward[k]);
  for (std::size_t k = points.size(); k-- > 0;) {
    VisiblePart part;
    other.find(points[k], Vec3::UnitZ(), 0, part);
    EXPECT_EQ(part.signature, forward[k].signature);
    ASSERT_EQ(part.pieces.size(), forward[k].pieces.size());
    for (std::size_t i = 0; i < part.pieces.size(); ++i)
      EXPECT_EQ(part.pieces[i].from, forward[k].pieces[i].from);
  }
}

TEST(VisiblePartFinder, AllocatesNothingOnceItsBuffersHaveGrown) {
  if (!test::counts_allocations) GTEST_SKIP() << "a sanitizer allocates";
  const SoundScene scene = sphere_scene(3);
  const OpaqueScene opaque(scene);
  VisiblePartFinder finder(opaque);
  VisiblePart part;
  std::vector<Vec3> points;
  Random random(3);
  for (int k = 0; k < 300; ++k) points.emplace_back(random(-1.5, 1.5), random(-1.5, 1.5), 0);
  const auto find_all = [&] {
    for (const Vec3& point : points) finder.find(point, Vec3::UnitZ(), 0, part);
  };
  find_all();
  const std::size_t before = test::allocations();
  find_all();
  EXPECT_EQ(test::allocations(), before);
  std::vector<int> grown(100);
  EXPECT_GT(test::allocations(), before);  // the counter counts
}

TEST(VisiblePartFinder, ASpheresHiddenPartIsThatOfItsOutline) {
  // Seen from a point below its centre, the sphere's outline is a regular polygon up to its
  // fineness; the form factor to a sphere straight above is (r / distance)².
  SoundScene scene;
  test::add_lit_surface(scene, facing_down(-5, 5, -5, 5, 2), 1);
  test::add_sphere(scene, {0, 0, 1}, .3, 5);
  test::finish(scene);
  const VisiblePart part = find_visible(scene, Vec3::Zero());
  const double hidden = test::lambert(part.unobstructed, Vec3::Zero(), Vec3::UnitZ()) -
                        test::lambert(part.pieces, Vec3::Zero(), Vec3::UnitZ());
  EXPECT_NEAR(hidden, .09, .09 * 2e-3);
  EXPECT_LT(hidden, .09);
}

}  // namespace
}  // namespace halfshade
