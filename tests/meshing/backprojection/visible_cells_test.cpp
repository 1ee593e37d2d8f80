#include "meshing/backprojection/edge_sum.h"
#include "meshing/backprojection/visible_part.h"
#include "meshing/repair/repair.h"
#include "tests/support/scenes.h"
#include "tests/support/triangle_soups.h"
#include "tests/support/turned_slats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

// An emitter looked at in cells shows as much as looked at as a whole.

namespace halfshade {
namespace {

struct InCells {
  double factor = 0;
  std::size_t work = 0;
  std::set<Region> regions;
};

class Views {
 public:
  explicit Views(const Scene& scene)
      : scene_(make_sound(scene, {.contacts = false})), opaque_(scene_), finder_(opaque_) {}

  const SoundScene& scene() const { return scene_; }

  InCells in_cells(const Vec3& point, const Vec3& normal, int emitter) {
    InCells result;
    result.work =
        finder_.find_in_cells(point, normal, emitter, part_, [&](const VisiblePart& part) {
          result.factor += enclosed_factor(point, normal, part.pieces);
          result.regions.insert(part.region);
        });
    return result;
  }
  VisiblePart whole(const Vec3& point, const Vec3& normal, int emitter) {
    finder_.find(point, normal, emitter, part_);
    return part_;
  }
  bool find_unless_crowded(const Vec3& point, const Vec3& normal, int emitter) {
    return finder_.find_unless_crowded(point, normal, emitter, part_);
  }
  Region region(const Vec3& point, const Vec3& normal, int emitter) {
    return finder_.region(point, normal, emitter);
  }
  const VisiblePart& part() const { return part_; }
  const SightEffort& effort() const { return finder_.effort(); }
  int emitter() const {
    const auto emits = [&](const Surface& surface) {
      return (scene_.materials[at(surface.material)].exitance > 0).any();
    };
    return static_cast<int>(std::ranges::find_if(scene_.surfaces, emits) - scene_.surfaces.begin());
  }

 private:
  SoundScene scene_;
  OpaqueScene opaque_;
  VisiblePartFinder finder_;
  VisiblePart part_;
};

void expect_same(const Scene& input, std::uint64_t seed, int count) {
  Views views(input);
  test::Random random(seed);
  int seen = 0, hidden = 0;
  for (int k = 0; k < count; ++k) {
    const auto& surfaces = views.scene().surfaces;
    const Surface& surface = surfaces[at(1 + random.below(static_cast<int>(surfaces.size()) - 1))];
    const Ring& ring = surface.rings[0];
    const double u = random(0, 1), v = random(0, 1 - u);
    const Vec3 point =
        surface.frame.to_space(ring[0] + u * (ring[1] - ring[0]) + v * (ring[2] - ring[0]));
    const VisiblePart whole = views.whole(point, surface.frame.normal, 0);
    const InCells cells = views.in_cells(point, surface.frame.normal, 0);
    EXPECT_NEAR(cells.factor, enclosed_factor(point, surface.frame.normal, whole.pieces), 1e-12);
    EXPECT_EQ(cells.regions.empty(), whole.region == Region::away);
    const auto all = [&](Region region) { return cells.regions == std::set<Region>{region}; };
    EXPECT_EQ(all(Region::umbra), whole.region == Region::umbra);
    EXPECT_EQ(all(Region::lit), whole.region == Region::lit);
    seen += whole.region == Region::penumbra;
    hidden += whole.region == Region::umbra;
    // The amount of work does not depend on what was asked before.
    views.in_cells(random.point(0, 1), random.direction(), 0);
    EXPECT_EQ(views.in_cells(point, surface.frame.normal, 0).work, cells.work);
  }
  EXPECT_GT(seen, count / 50);
  EXPECT_GT(hidden, count / 20);
}

TEST(VisibleCells, ShowWhatTheWholeShows) {
  expect_same(test::unit_soup(60, 3), 1, 400);
  expect_same(test::unit_soup(200, 4), 2, 200);
}

TEST(VisibleCells, ShowItWhereManyEdgesMeet) { expect_same(test::grid_soup(60, 4, 5), 3, 400); }

TEST(VisibleCells, AreForCrowdedViewsOnly) {
  Views few(test::unit_soup(5, 1)), many(test::unit_soup(300, 1));
  test::Random random(5);
  int crowded = 0;
  for (int k = 0; k < 100; ++k) {
    const Vec3 point = random.point(0, 1), normal = random.direction();
    EXPECT_TRUE(few.find_unless_crowded(point, normal, 0));
    EXPECT_EQ(few.part().signature, few.whole(point, normal, 0).signature);
    crowded += !many.find_unless_crowded(point, normal, 0);
  }
  EXPECT_GT(crowded, 10);
}

// As many edges cross as in a crowded view, but what crosses is seen: cells would have to look at
// it, too. All of the light lies behind both layers; with 19.2 and 21.2 gaps a metre of it, turned
// by 37 degrees, that makes 245 openings of four sides.
TEST(VisibleCells, AreNotForWhatIsSeen) {
  Views views(test::turned_slats(150));
  const int emitter = views.emitter();
  test::Random random(6);
  for (int k = 0; k < 20; ++k) {
    const Vec3 point(random(-2, 2), random(-2, 2), 0);
    ASSERT_TRUE(views.find_unless_crowded(point, Vec3::UnitZ(), emitter));
    const double factor = enclosed_factor(point, Vec3::UnitZ(), views.part().pieces);
    EXPECT_GT(views.part().pieces.size(), 900U);
    EXPECT_NEAR(views.in_cells(point, Vec3::UnitZ(), emitter).factor, factor, 1e-14);
  }
}

// A few directions often tell the region: what they tell must be so, also where many corners, edges
// and planes are the same.
TEST(VisiblePart, RegionIsThatOfTheWholePart) {
  test::Random random(7);
  const auto blinds = [&] { return Vec3(random(-4, 4), random(-4, 4), 0); };
  const auto cube = [&] { return random.point(0, 1); };
  const auto grid = [&] {
    const auto half = [&] { return 0.5 * random.integer(0, 8); };
    const double x = half(), y = half(), z = half();
    return Vec3(x, y, z);
  };
  const auto expect_same = [&](const Scene& scene, const auto& place) {
    Views views(scene);
    const int emitter = views.emitter();
    int penumbra = 0;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 point = place();
      const Vec3 normal = k % 2 == 0 ? Vec3(Vec3::UnitZ()) : random.point(-1, 1).normalized();
      const Region whole = views.whole(point, normal, emitter).region;
      EXPECT_EQ(views.region(point, normal, emitter), whole) << point.transpose();
      penumbra += whole == Region::penumbra;
    }
    EXPECT_GT(penumbra, 50);
  };
  expect_same(test::turned_slats(10), blinds);
  expect_same(test::unit_soup(20, 3), cube);
  expect_same(test::grid_soup(20, 4, 5), grid);
}

// Most slats of the turned layer pass beside the light, and there cross all of the other one.
TEST(VisiblePart, TakesNoWorkForWhatCrossesBesideTheEmitter) {
  Views views(test::turned_slats(50));
  const int emitter = views.emitter();
  const SightEffort before = views.effort();
  views.whole({0.1, 0.2, 0}, Vec3::UnitZ(), emitter);
  EXPECT_LT((views.effort() - before).turns, 2000U);
}

/// A light of 1 by 1 two above the origin's corner, a face below it and 300 triangles in between.
Scene crowd_behind(const std::vector<Vec3>& face) {
  Scene scene;
  const int black = test::add_material(scene, 0, 0), light = test::add_material(scene, 0, 1);
  test::add_polygon(scene, {{0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2}}, light);
  test::add_polygon(scene, face, black);
  test::Random random(8);
  for (int k = 0; k < 300; ++k) {
    const auto corner = [&] { return Vec3(random(0, 1), random(0, 1), random(1.3, 1.9)); };
    const Vec3 a = corner(), b = corner();
    test::add_polygon(scene, {a, b, corner()}, black);
  }
  return scene;
}

// One whose border passes a corner of the light, whose ends lie beyond no side of it both; and one
// that rises above the light.
TEST(VisiblePart, TakesNoWorkForWhatLiesBehindAFaceThatHidesAll) {
  for (const std::vector<Vec3>& face :
       {std::vector<Vec3>{{-0.1, -0.1, 1}, {1.65, -0.1, 1}, {-0.1, 1.65, 1}},
        std::vector<Vec3>{{-5, -5, 0.2}, {10, -5, 0.2}, {0.5, 20, 4}}}) {
    Views views(crowd_behind(face));
    const SightEffort before = views.effort();
    EXPECT_EQ(views.whole({0.5, 0.5, 0}, Vec3::UnitZ(), views.emitter()).region, Region::umbra);
    EXPECT_LT((views.effort() - before).turns, 2000U);
  }
}

}  // namespace
}  // namespace halfshade
