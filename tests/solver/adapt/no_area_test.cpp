#include "solver/adapt/near_looks.h"
#include "solver/adapt/possible_wholes.h"
#include "tests/support/fields_on_square.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

// Corners of elements may be at one place: of surfaces told in few digits, whose borders meet there
// but for rounding. What has no area is off by nothing, and takes no looks.

namespace halfshade {
namespace {

FittedElement element_of(const ElementTable& table, int e) {
  FittedElement element;
  element.triangle = table.triangle(e);
  element.normal = table.normal[at(e)];
  element.area = table.area[at(e)];
  element.fit.order = 0;
  element.fit.coefficients = ChannelArray::Ones(1, 3);
  element.fit.error = 0.1;
  return element;
}

/// A corner that touches the square, and an edge that rises from it.
Watched watched_at(const Vec3& foot) {
  Watched watched;
  watched.corners.push_back({0, foot, 0});
  watched.edges.push_back({0, {foot, foot + Vec3(0.3, 0.4, 0)}, {1e-3, 0.2}});
  return watched;
}

TEST(ElementsWithoutArea, TakeNoLooks) {
  const SoundScene scene = test::square();
  const PatchMesh mesh = test::mesh_of(scene, 0);
  FittedElement element = element_of(mesh.elements(), 0);
  const Watched watched = watched_at(element.triangle[1]);
  EXPECT_FALSE(near_looks(std::array{element}, watched, 1, 1000).empty());
  element.triangle[2] = element.triangle[1];
  element.area = 0;
  EXPECT_TRUE(near_looks(std::array{element}, watched, 1, 1000).empty());
}

TEST(ElementsWithoutArea, AreNoWholes) {
  const SoundScene scene = test::square();
  PatchMesh mesh = test::mesh_of(scene, 0);
  mesh.split_in_four(std::vector<int>{0});
  std::vector<FittedElement> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    elements.push_back(element_of(mesh.elements(), e));
    elements.back().is_checked = true;
  }
  const std::vector<PossibleWhole> wholes = possible_wholes(mesh, elements, -1, max_order);
  ASSERT_FALSE(wholes.empty());
  EXPECT_TRUE(std::isfinite(wholes[0].more));
  for (FittedElement& element : elements) element.area = 0;
  EXPECT_TRUE(possible_wholes(mesh, elements, -1, max_order).empty());
}

}  // namespace
}  // namespace halfshade
