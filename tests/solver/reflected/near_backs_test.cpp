#include "solver/reflected/near_backs.h"

#include "meshing/repair/repair.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

// A square ceiling with a plate below it whose back hides the half of it where x < 0. What is seen
// past the edge of a wide plate at a distance x from it is (1 + x / √(x² + g²)) / 2 for a gap g.

namespace halfshade {
namespace {

constexpr double wide = 30;

ReflectingScene plate_below_a_ceiling(double gap, double reach, bool is_turned = false) {
  Scene scene;
  const int white = test::add_material(scene, 0.9, 0);
  test::add_polygon(scene, {{-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}}, white);
  std::vector<Vec3> plate = {
      {-wide, -wide, -gap}, {-wide, wide, -gap}, {reach, wide, -gap}, {reach, -wide, -gap}};
  if (is_turned) std::reverse(plate.begin(), plate.end());
  test::add_polygon(scene, plate, white);
  return make_reflecting_scene(make_sound(scene));
}

/// The ceiling in two triangles, and their shadows.
std::vector<BackShadow> shadows(const ReflectingScene& scene, int order,
                                double most_looks = looks_to_put_right) {
  const ReflectedMesh mesh = make_reflected_mesh(scene.roots, 100, order, 1000);
  const NearBacks backs(scene);
  std::vector<BackShadow> result;
  for (int e = 0; e < mesh.count(); ++e)
    if (scene.roots.triangle(mesh.root(e))[0].z() == 0)
      result.push_back(backs.shadow(mesh, e, most_looks));
  return result;
}

/// The edge runs for a length of 1 through each triangle, of which x > 0 is a quarter or three, and
/// whose centroids are at x = ±1/3. An element with one node takes all for dark or all for bright.
/// If it is bright, ∫ ω (ω − 1) is −1/4 ∫ g² / (x² + g²) dx, which is −π g / 4 in a narrow gap.
TEST(NearBacks, WhatIsMissedOfAStraightEdgeIsKnown) {
  for (const double gap : {0.003, 0.001, 0.0003}) {
    const std::vector<BackShadow> found = shadows(plate_below_a_ceiling(gap, 0), 0);
    ASSERT_EQ(found.size(), 2U);
    int bright = 0;
    for (const BackShadow& shadow : found) {
      EXPECT_DOUBLE_EQ(shadow.height, gap);
      if (shadow.share > 0) continue;
      ++bright;
      ASSERT_EQ(shadow.of_nodes.size(), 1);
      const double area = 2, lit = 1.5 / area;
      EXPECT_NEAR(shadow.share * lit * lit * area, -M_PI / 4 * gap, 0.03 * gap) << gap;
    }
    EXPECT_EQ(bright, 1) << "the other one's node is hidden: what it should send is missing";
  }
}

/// The same plate in so many strips across its edge.
ReflectingScene strips_below_a_ceiling(double gap, int strips) {
  Scene scene;
  const int white = test::add_material(scene, 0.9, 0);
  test::add_polygon(scene, {{-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}}, white);
  const int grey = test::add_material(scene, 0.8, 0);  // so that strips are not joined
  double from = -wide;
  for (int k = 0; k <= strips; ++k) {
    const double to = k == strips ? wide : 4. * k / (strips - 1) - 2;
    test::add_polygon(scene,
                      {{-wide, from, -gap}, {-wide, to, -gap}, {0, to, -gap}, {0, from, -gap}},
                      k % 2 == 0 ? white : grey);
    from = to;
  }
  return make_reflecting_scene(make_sound(scene));
}

TEST(NearBacks, WhatIsNotLookedAtPastManyCountsAsMissed) {
  constexpr double gap = 0.01;
  int bright = 0;
  for (const BackShadow& shadow : shadows(strips_below_a_ceiling(gap, 60), 0)) {
    if (shadow.share > 0) continue;
    ++bright;
    EXPECT_GT(shadow.unsure, 0.3);
    // What even light past one back would leave unknown, a fifth, is taken for known here.
    const double known = shadow.share * (1 - shadow.unsure) / 0.8;
    const double area = 2, lit = 1.5 / area;
    EXPECT_NEAR(known * lit * lit * area, -M_PI / 4 * gap, 0.1 * gap);
  }
  EXPECT_EQ(bright, 1);
}

// As few as errors are known by; of ten, places may miss the border altogether.
TEST(NearBacks, FewLooksTellThatNoLessIsMissed) {
  const ReflectingScene scene = plate_below_a_ceiling(0.01, 0);
  const std::vector<BackShadow> all = shadows(scene, 0);
  for (const double looks : {100., 300., 1000., 3000.}) {
    const std::vector<BackShadow> found = shadows(scene, 0, looks);
    for (std::size_t e = 0; e < all.size(); ++e) {
      EXPECT_GE(std::abs(found[e].share), 0.99 * std::abs(all[e].share)) << looks;
      if (looks < 3000) continue;
      EXPECT_LE(std::abs(found[e].share), 2 * std::abs(all[e].share));
    }
  }
}

TEST(NearBacks, NodesMissLessWhereElementsAreSmall) {
  const ReflectingScene scene = plate_below_a_ceiling(0.03, 0);
  const NearBacks backs(scene);
  const auto missed = [&](double length) {
    const ReflectedMesh mesh = make_reflected_mesh(scene.roots, length, 2, 100000);
    double sum = 0;
    for (int e = 0; e < mesh.count(); ++e)
      if (mesh.forest.corners(mesh.triangle[at(e)])[0].z() == 0)
        sum += mesh.area(e) * std::abs(backs.shadow(mesh, e, looks_to_put_right).share);
    return sum;
  };
  const double coarse = missed(1), fine = missed(0.12);
  EXPECT_GT(coarse, 0.01);
  EXPECT_LT(fine, 0.25 * coarse);
}

TEST(NearBacks, FrontsAndBacksThatAreFarAwayCountForNothing) {
  for (const BackShadow& shadow : shadows(plate_below_a_ceiling(0.01, 0, true), 2))
    EXPECT_EQ(shadow.of_nodes.size(), 0) << "its front faces the ceiling";
  for (const BackShadow& shadow : shadows(plate_below_a_ceiling(4, 0), 2))
    EXPECT_EQ(shadow.of_nodes.size(), 0);
  for (const BackShadow& shadow : shadows(plate_below_a_ceiling(0.01, -5), 2))
    EXPECT_EQ(shadow.of_nodes.size(), 0);
}

}  // namespace
}  // namespace halfshade
