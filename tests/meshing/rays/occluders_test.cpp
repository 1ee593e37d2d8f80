#include "meshing/rays/visibility.h"
#include "meshing/repair/repair.h"
#include "tests/support/element_occluders.h"
#include "tests/support/scenes.h"
#include "tests/support/soups.h"

#include <gmock/gmock.h>
#include <map>

namespace halfshade {
namespace {

/// Sum of the area vectors of the triangles of each owner.
std::map<int, Vec3> area_vectors(const TriangleSoup& soup) {
  std::map<int, Vec3> sums;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto c = test::corners(soup, t);
    auto [sum, fresh] = sums.try_emplace(soup.owner[t], Vec3::Zero());
    sum->second += (c[1] - c[0]).cross(c[2] - c[0]) / 2;
  }
  return sums;
}

TEST(Occluders, CoverTheSurfacesAndFaceAsTheyDo) {
  const SoundScene scene = make_sound(test::l_room(true));
  const TriangleSoup soup = occluders(scene);
  const auto sums = area_vectors(soup);
  ASSERT_EQ(sums.size(), scene.surfaces.size());
  for (const auto& [owner, sum] : sums) {
    const Surface& surface = scene.surfaces[static_cast<std::size_t>(owner)];
    EXPECT_LT((sum - area(surface) * surface.frame.normal).norm(), 1e-12) << owner;
  }
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    EXPECT_EQ(soup.plane[t], scene.surfaces[static_cast<std::size_t>(soup.owner[t])].plane);
}

TEST(Occluders, OfAClosedRoomLetNothingThrough) {
  const VisibilityIndex index(occluders(make_sound(test::l_room(true))));
  test::Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 inside(random(0.05, 0.4), random(0.05, 0.95), random(0.05, 0.95));
    EXPECT_TRUE(index.blocked(Segment{inside, inside + 10 * random.point(-1, 1).normalized()}));
  }
  // From corner to corner of the L across the missing quadrant, and along its
  // legs.
  EXPECT_TRUE(index.blocked(Segment{{1.9, 0.9, 0.5}, {0.9, 1.9, 0.5}}));
  EXPECT_FALSE(index.blocked(Segment{{1.9, 0.1, 0.9}, {0.1, 0.1, 0.1}}));
  EXPECT_TRUE(index.blocked(Segment{{0.6, 0.1, 0.5}, {0.6, 1.9, 0.5}}));  // the hanging box
}

TEST(Occluders, CountTwoSidedFacesOnce) {
  Scene scene;
  const int sheet = test::add_material(scene, 0.5, 1);
  scene.materials[static_cast<std::size_t>(sheet)].two_sided = true;
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, sheet);
  const SoundScene sound = make_sound(scene);
  ASSERT_EQ(sound.surfaces.size(), 2u);
  const TriangleSoup soup = occluders(sound);
  EXPECT_EQ(soup.triangles.size(), 2u);
  ASSERT_EQ(area_vectors(soup).size(), 1u);
  EXPECT_LT((area_vectors(soup).begin()->second - Vec3(0, 0, 1)).norm(), 1e-14);
}

TEST(Occluders, OfElementsAreTheElements) {
  ElementTable elements;
  elements.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  elements.corners = {{0, 1, 2}, {0, 2, 3}};
  const TriangleSoup soup = test::occluders(elements);
  EXPECT_EQ(soup.triangles, elements.corners);
  EXPECT_THAT(soup.owner, testing::ElementsAre(0, 1));
  EXPECT_THAT(soup.plane, testing::ElementsAre(-1, -1));
  EXPECT_EQ(VisibilityIndex(soup).first_hit({0.2, 0.7, 1}, {0, 0, -1})->owner, 1);
}

}  // namespace
}  // namespace halfshade
