#include "solver/elements/element_lookup.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "solver/elements/element_field.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

/// Elements of a room, bisected again and again at a corner of it: from 1 to 1e-4 in size.
ElementTable uneven_elements() {
  PatchMesh mesh(make_sound(test::lit_cube({0, 0, 0, 0, 0, 0})), {});
  for (int round = 0; round < 25; ++round) {
    const ElementTable elements = mesh.elements();
    std::vector<int> at_corner;
    for (int e = 0; e < elements.count(); ++e)
      for (const Vec3& p : elements.triangle(e))
        if (p.norm() == 0) at_corner.push_back(e);
    mesh.bisect(at_corner);
  }
  return mesh.elements();
}

TEST(ElementLookup, FindsPlacesInElementsOfAnySize) {
  const ElementTable elements = uneven_elements();
  ASSERT_LT(*std::min_element(elements.area.begin(), elements.area.end()), 1e-6);
  const ElementLookup lookup(elements);
  test::Random random(1);
  for (int e = 0; e < elements.count(); ++e)
    for (int k = 0; k < 20; ++k) {
      TrianglePlace place(random(0, 1), random(0, 1));
      if (place.sum() > 1) place = TrianglePlace(1, 1) - place;
      const ForestPlace found =
          lookup.find(elements.surface[at(e)], position(elements.triangle(e), place));
      ASSERT_EQ(found.triangle, e) << place.transpose();
      EXPECT_LT((found.place - place).norm(), 1e-9);
    }
}

TEST(ElementLookup, OnCommonEdgesTheFirstElementCounts) {
  const ElementTable elements = uneven_elements();
  const ElementLookup lookup(elements);
  for (int e = 0; e < elements.count(); ++e)
    for (std::size_t k = 0; k < 3; ++k) {
      const int other = elements.neighbours[at(e)][k];
      if (other < 0 || elements.surface[at(other)] != elements.surface[at(e)]) continue;
      const auto corners = elements.triangle(e);
      const Vec3 middle = 0.5 * (corners[k] + corners[(k + 1) % 3]);
      EXPECT_EQ(lookup.find(elements.surface[at(e)], middle).triangle, std::min(e, other));
    }
}

/// Triangles from a corner to far away, hundreds of times as long as wide.
ElementTable splinters() {
  constexpr int count = 1500;
  ElementTable elements;
  elements.points.emplace_back(0, 0, 0);
  for (int k = 0; k <= count; ++k)
    elements.points.emplace_back(1, static_cast<double>(k) / count, 0);
  for (int k = 0; k < count; ++k) {
    elements.corners.push_back({0, k + 1, k + 2});
    elements.surface.push_back(0);
    elements.normal.push_back(Vec3::UnitZ());
    elements.area.push_back(0.5 / count);
  }
  return elements;
}

TEST(ElementLookup, FindsPlacesInSplinters) {
  const ElementTable elements = splinters();
  const ElementLookup lookup(elements);
  test::Random random(3);
  for (int e = 0; e < elements.count(); ++e)
    for (int k = 0; k < 20; ++k) {
      const double far = random(0.01, 0.99), across = random(0.01, 0.99);
      const TrianglePlace place(far * across, far * (1 - across));
      const ForestPlace found = lookup.find(0, position(elements.triangle(e), place));
      ASSERT_EQ(found.triangle, e) << place.transpose();
    }
}

TEST(ElementLookup, SplintersTakeLittleMemory) {
  const ElementTable elements = splinters();
  // Cells with four elements at most, of any size, would be 17,000 for each.
  EXPECT_LT(ElementLookup(elements).entries(), 3000 * elements.corners.size());
}

TEST(ElementLookup, PointsBesideASurfaceBelongToWhatIsNext) {
  const ElementTable elements = uneven_elements();
  const ElementLookup lookup(elements);
  for (int e = 0; e < elements.count(); ++e)
    for (const Vec3& p : elements.triangle(e)) {
      const ForestPlace found =
          lookup.find(elements.surface[at(e)], p + 1e-14 * (p - Vec3::Constant(0.5)));
      ASSERT_GE(found.triangle, 0);
      EXPECT_LT((position(elements.triangle(found.triangle), found.place) - p).norm(), 1e-12);
    }
  EXPECT_EQ(lookup.find(1000, Vec3::Zero()).triangle, -1);
}

/// Corners that neighbours share lie off the plane by rounding, so that a splinter between them may
/// stand upright: seen along itself it would hold all places between its ends.
TEST(ElementLookup, SplintersHoldOnlyWhatIsBetweenTheirEdges) {
  ElementTable elements;
  elements.points = {{0, 0, 0}, {1, 0, 0}, {1, 1e-9, 1e-7}, {1, 1, 0}, {0, 1, 0}};
  elements.corners = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  elements.neighbours.assign(3, {-1, -1, -1});
  elements.normal.assign(3, Vec3::UnitZ());
  elements.area = {5e-8, 0.5, 0.5};
  elements.surface.assign(3, 0);
  const ElementLookup lookup(elements);
  test::Random random(3);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 p(random(0, 1), random(0, 1), 0);
    if (std::abs(p.x() - p.y()) < 1e-6 || p.y() < 1e-6) continue;
    EXPECT_EQ(lookup.find(0, p).triangle, p.y() < p.x() ? 1 : 2) << p.transpose();
  }
  EXPECT_EQ(lookup.find(0, {0.5, 2e-10, 0}).triangle, 0);
  elements.points[2] = {0.5, 0, 1e-7};
  const ForestPlace found = ElementLookup(elements).find(0, {0.7, 0.2, 0});
  EXPECT_EQ(found.triangle, 1) << "what stands upright holds nothing";
  EXPECT_TRUE(found.place.allFinite());
}

}  // namespace
}  // namespace halfshade
