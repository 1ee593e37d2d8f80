#include "meshing/core/planar.h"
#include "solver/factors/factor_matrix.h"
#include "solver/factors/few_blockers.h"
#include "solver/factors/joined_scene.h"
#include "solver/factors/lattice_sight.h"
#include "solver/factors/mutual_sight.h"
#include "solver/factors/pair_search.h"
#include "solver/factors/point_looks.h"
#include "tests/solver/factors/sight_points.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// A parallelogram of n × n faces, counter-clockwise seen from where u × v points.
void add_tiles(Scene& scene, const Vec3& corner, const Vec3& u, const Vec3& v, int n) {
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Vec3 p = corner + i * u / n + j * v / n;
      test::add_polygon(scene, {p, p + u / n, p + u / n + v / n, p + v / n}, 0);
    }
}

void add_box(Scene& scene, const Vec3& low, const Vec3& size, int n, bool outwards) {
  const std::array<Vec3, 3> e = {Vec3(size.x(), 0, 0), Vec3(0, size.y(), 0), Vec3(0, 0, size.z())};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &u = e[(k + 1) % 3], &v = e[(k + 2) % 3];
    add_tiles(scene, low, outwards ? v : u, outwards ? u : v, n);
    add_tiles(scene, low + e[k], outwards ? u : v, outwards ? v : u, n);
  }
}

/// A room of tiles with a box of tiles, one that stands in a corner, and a sheet that looks up.
Scene tiled_room() {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  add_box(scene, Vec3::Zero(), {3, 3.1, 2.9}, 5, false);
  add_box(scene, {.9, .8, .7}, {1.2, 1.1, 1.3}, 2, true);
  add_box(scene, {.2, 2.2, .4}, {.5, .4, .6}, 1, true);
  add_tiles(scene, {1.9, 1.8, .5}, {.8, 0, 0}, {0, .8, .1}, 1);
  return scene;
}

struct Sights {
  FactorScene scene;
  SightScene sight;

  explicit Sights(const Scene& given)
      : scene(make_factor_scene(given, FactorUnit::face)), sight(make_sight_scene(scene.sound)) {}
  int count() const { return static_cast<int>(sight.surfaces.size()); }
};

TEST(JoinedScene, WallsOfTilesAreOnePolygon) {
  const Sights room(tiled_room());
  const JoinedScene& joined = room.sight.joined;
  ASSERT_EQ(joined.of.size(), room.sight.surfaces.size());
  std::vector<double> areas(joined.parts.size(), 0);
  for (std::size_t s = 0; s < joined.of.size(); ++s) {
    areas[at(joined.of[s])] += room.sight.surfaces[s].area;
    EXPECT_EQ(joined.sound.surfaces[at(joined.of[s])].plane, room.sight.surfaces[s].plane);
  }
  int of_walls = 0, of_sides = 0;
  for (std::size_t j = 0; j < areas.size(); ++j) {
    EXPECT_NEAR(area(joined.sound.surfaces[j]), areas[j], 1e-13);
    EXPECT_EQ(joined.sound.surfaces[j].rings.front().size(), 4u) << "no corners of tiles are left";
    of_walls += joined.parts[j].size() == 25;
    of_sides += joined.parts[j].size() == 4;
  }
  EXPECT_EQ(of_walls, 12) << "walls and their backs";
  EXPECT_EQ(of_sides, 12) << "the box's sides and their backs";
}

TEST(JoinedScene, RingsOfTilesLeaveAHole) {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  for (int k = 0; k < 9; ++k)
    if (k != 4) add_tiles(scene, {k % 3 * 1., k / 3 * 1., 0}, {1, 0, 0}, {0, 1, 0}, 1);
  const Sights ring(scene);
  EXPECT_EQ(ring.sight.joined.sound.surfaces[0].rings.size(), 2u);
  EXPECT_EQ(ring.sight.joined.parts[0].size(), 8u);
}

TEST(ConvexBodies, OnlyClosedOnesThatLookOutwards) {
  const Sights room(tiled_room());
  ASSERT_EQ(room.sight.bodies.size(), 2u) << "not the room, and not the sheet";
  for (const ConvexBody& body : room.sight.bodies) {
    EXPECT_EQ(body.vertices.size(), 8u);
    EXPECT_EQ(body.sides.size(), 6u);
    EXPECT_EQ(body.edges.size(), 12u);
  }
}

/// Every way to a point factor gives what exactly visible parts among all tiles give.
TEST(PointLooks, AgreeWithExactPartsOfTiles) {
  const Sights room(tiled_room());
  const DirectLightIndex tiles(room.scene.sound);
  PointLooks looks(room.sight);
  test::Random random(7);
  int partial = 0, hidden = 0, lit = 0, few = 0;
  for (int k = 0; k < 6000; ++k) {
    const int a = random.below(room.count()), b = random.below(room.count());
    if (room.sight.surfaces[at(a)].outline.size() != 4 || !may_see(room.sight, a, b)) continue;
    const SightSurface& from = room.sight.surfaces[at(a)];
    const SurfacePoint point{test::point_of(from, random), from.frame.normal};
    const PointFactor expected = tiles.factor(point, b);
    const PointFactor looked = looks.factor(point, b);
    EXPECT_NEAR(looked.visible, expected.visible, 1e-13);
    EXPECT_NEAR(looked.unobstructed, expected.unobstructed, 1e-13);
    partial += expected.region == Region::penumbra;
    hidden += expected.region == Region::umbra;
    lit += expected.region == Region::lit;
    if (expected.region != Region::penumbra && expected.unobstructed > 1e-12) {
      EXPECT_EQ(looked.visible, expected.region == Region::lit ? looked.unobstructed : 0);
    }
    FewBlockers blockers(room.sight, a, b);
    HiddenFactor cut;
    if (!blockers.is_applicable() || !blockers.factor(point.position, cut)) continue;
    ++few;
    EXPECT_NEAR(cut.visible(), expected.visible, 1e-13);
    EXPECT_NEAR(cut.hidden, expected.unobstructed - expected.visible, 1e-13);
    EXPECT_NEAR(cut.unobstructed, expected.unobstructed, 1e-13);
  }
  EXPECT_GT(partial, 100);
  EXPECT_GT(hidden, 100);
  EXPECT_GT(lit, 100);
  EXPECT_GT(few, partial + hidden);
}

/// Shadows that serve all surfaces of a plane tell what exactly visible parts among all tiles tell,
/// whatever was asked for before from the same point.
TEST(ShadedTarget, AgreesWithExactPartsOfTiles) {
  const Sights room(tiled_room());
  const DirectLightIndex tiles(room.scene.sound);
  test::Random random(11);
  int partial = 0, dark = 0, lit = 0;
  for (int a = 0; a < room.count(); a += 3) {
    const SightSurface& from = room.sight.surfaces[at(a)];
    if (from.outline.size() != 4) continue;
    SharedShadows shadows(room.sight);
    TargetMemory memory;
    const auto targets = test::targets_of(room.sight, a, shadows, memory);
    for (int k = 0; k < 3; ++k) {
      const Vec3 point = test::point_of(from, random);
      shadows.move_to(point);
      for (const auto& [b, target] : targets) {
        HiddenFactor found;
        ASSERT_TRUE(target.hidden_factor(found));
        const PointFactor expected = tiles.factor({point, from.frame.normal}, b);
        EXPECT_NEAR(found.hidden, expected.unobstructed - expected.visible, 1e-13);
        partial += expected.region == Region::penumbra;
        dark += expected.region == Region::umbra;
        lit += expected.region == Region::lit;
        if (expected.unobstructed > 1e-12) {
          EXPECT_EQ(found.is_dark, expected.region == Region::umbra) << a << " " << b;
        }
        if (expected.region == Region::lit) {
          EXPECT_EQ(found.hidden, 0);
        }
      }
    }
  }
  EXPECT_GT(partial, 1000);
  EXPECT_GT(dark, 300);
  EXPECT_GT(lit, 1000);
}

TEST(PointLooks, WhatIsKeptChangesNoBit) {
  const Sights room(tiled_room());
  PointLooks kept(room.sight);
  test::Random random(9);
  const SightSurface& from = room.sight.surfaces[0];
  for (int k = 0; k < 20; ++k) {
    const SurfacePoint point{test::point_of(from, random), from.frame.normal};
    for (int b = 0; b < room.count(); ++b) {
      PointLooks fresh(room.sight);
      const PointFactor one = kept.factor(point, b), other = fresh.factor(point, b);
      EXPECT_EQ(one.visible, other.visible);
      EXPECT_EQ(one.signature, other.signature);
    }
  }
}

/// By groups, and pair by pair; and what is said to be hidden or clear is, at points.
TEST(PairSearch, AgreesWithPairsAndPoints) {
  const Sights room(tiled_room());
  const DirectLightIndex tiles(room.scene.sound);
  const auto pairs = find_pairs(room.scene, room.sight, {});
  test::Random random(3);
  int none = 0, clear = 0, partial = 0;
  for (int a = 0; a < room.count(); ++a) {
    if (room.scene.row[at(a)] < 0) {
      EXPECT_TRUE(pairs[at(a)].empty());
      continue;
    }
    std::size_t next = 0;
    for (int b = 0; b < room.count(); ++b) {
      if (room.scene.row[at(b)] >= 0 && b <= a) continue;
      Sight found = Sight::none;
      if (next < pairs[at(a)].size() && pairs[at(a)][next].other == b)
        found = pairs[at(a)][next++].sight;
      const Sight alone = sight_between(room.sight, a, b);
      if (found != Sight::partial) {
        EXPECT_EQ(found, alone) << a << " " << b;
      }
      none += found == Sight::none && may_see(room.sight, a, b);
      clear += found == Sight::clear;
      partial += found == Sight::partial;
      if (found == Sight::partial || !may_see(room.sight, a, b)) continue;
      for (int k = 0; k < 3; ++k) {
        const SightSurface& from = room.sight.surfaces[at(a)];
        const PointFactor seen = tiles.factor({test::point_of(from, random), from.frame.normal}, b);
        EXPECT_NEAR(seen.visible, found == Sight::none ? 0 : seen.unobstructed, 1e-14);
      }
    }
    EXPECT_EQ(next, pairs[at(a)].size());
  }
  EXPECT_GT(none, 50);
  EXPECT_GT(clear, 500);
  EXPECT_GT(partial, 500);
}

FactorMatrix matrix_of(const Scene& scene, double tolerance) {
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.tolerance = tolerance;
  return form_factor_matrix(scene, options);
}

TEST(JoinedSight, RowsOfTilesSumToOneAtAnyScale) {
  const FactorMatrix plain = matrix_of(tiled_room(), 1e-3);
  EXPECT_LT((plain.row_sum - 1).abs().maxCoeff(), 1e-3);
  EXPECT_EQ(plain.report.rows_not_reached, 0);
  for (const double scale : {1e-9, 1e9}) {
    Scene scene = tiled_room();
    for (Vec3& p : scene.vertices) p *= scale;
    const FactorMatrix scaled = matrix_of(scene, 1e-3);
    EXPECT_LT((scaled.row_sum - 1).abs().maxCoeff(), 1e-3) << scale;
    EXPECT_LT((scaled.factors - plain.factors).cwiseAbs().maxCoeff(), 2e-4) << scale;
  }
  Scene scene = tiled_room();
  const Eigen::Index n = plain.area.size();
  test::add_polygon(scene, {{1e6, 0, 0}, {1e6, 1, 0}, {1e6, 0, 1}}, 0);
  const FactorMatrix with_far = matrix_of(scene, 1e-3);
  EXPECT_LT((with_far.factors.topLeftCorner(n, n) - plain.factors).cwiseAbs().maxCoeff(), 2e-4);
}

TEST(JoinedSight, BytesOfTilesDoNotDependOnThreads) {
  const FactorMatrix two = matrix_of(tiled_room(), 1e-2);
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  const FactorMatrix one = matrix_of(tiled_room(), 1e-2);
  EXPECT_EQ(one.factors, two.factors);
  EXPECT_TRUE((one.error == two.error).all());
}

/// By lattices as by cells that are far more exact, within what they say; and all pairs of a
/// surface at once are what each of them is alone.
TEST(JoinedSight, LatticesAgreeWithCells) {
  const Sights room(tiled_room());
  const SightTolerance tolerance{1e-3, 2e-4 * .04, 300000};
  const auto all = find_pairs(room.scene, room.sight, {});
  int found = 0, partial = 0, checked = 0;
  for (int a = 0; a < room.count(); ++a) {
    std::vector<LatticePair> pairs;
    for (const SightPair& pair : all[at(a)])
      if (pair.sight == Sight::partial) pairs.push_back({pair.other, tolerance, pair.blockers});
    const auto seen = lattice_sight(room.sight, a, pairs);
    ASSERT_EQ(seen.size(), pairs.size());
    for (std::size_t k = 0; k < seen.size(); ++k, ++partial) {
      if (!seen[k] || !seen[k]->is_reached) continue;
      ++found;
      EXPECT_LE(seen[k]->error, tolerance.absolute + tolerance.relative * seen[k]->value);
      if (found % 6 != 0) continue;
      const auto alone = lattice_sight(room.sight, a, {&pairs[k], 1});
      ASSERT_TRUE(alone.front());
      EXPECT_EQ(alone.front()->value, seen[k]->value);
      pairs[k].blockers = {};
      const auto searched = lattice_sight(room.sight, a, {&pairs[k], 1});
      ASSERT_TRUE(searched.front());
      EXPECT_NEAR(searched.front()->value, seen[k]->value, 1e-14);
      const MutualSight exact = partial_sight(room.sight, a, pairs[k].other, {1e-6, 1e-7, 300000});
      const double off = std::abs(seen[k]->value - exact.value) - exact.error;
      ++checked;
      EXPECT_LT(off, seen[k]->error);
    }
  }
  EXPECT_GT(found, partial / 2);
  EXPECT_GT(checked, 50);
}

/// Past many boxes all points of a cell may see the same edges, and two rules agree by chance. What
/// is expected is a sum over evenly spread points.
TEST(JoinedSight, CellsDoNotAgreeByChance) {
  constexpr int side = 1, tile = 6;  // faces: the side of the first box looks at the tile
  for (const double y : {.75, 2.25}) {
    Scene scene;
    test::add_material(scene, 0.5, 0);
    add_box(scene, {.8, 1.8, 2.8}, {.4, .4, .4}, 1, true);
    add_tiles(scene, {6, y, 1.5}, {0, 0, .75}, {0, .75, 0}, 1);
    for (int k = 0; k < 125; ++k)
      if (k != 7)  // the first one
        add_box(scene, {k / 25 + .8, k / 5 % 5 + .8, k % 5 + .8}, {.4, .4, .4}, 1, true);
    const Sights sights(scene);
    ASSERT_EQ(sights.scene.row[side], side);
    ASSERT_EQ(sights.scene.row[tile], tile);
    const MutualSight seen = partial_sight(sights.sight, tile, side, {8e-6, 2e-7, 300000});
    const Vec3 normal = sights.sight.surfaces[tile].frame.normal;
    PointLooks looks(sights.sight);
    constexpr int n = 256;
    double expected = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Vec3 point(6, y + .75 * (i + .5) / n, 1.5 + .75 * (j + .5) / n);
        expected += .75 * .75 / (n * n) * looks.factor({point, normal}, side).visible;
      }
    ASSERT_GT(expected, 1e-4);
    EXPECT_NEAR(seen.value, expected, seen.error);
  }
}

/// A lattice says nothing where things are narrower than its points are apart, or where all points
/// see nothing; and it takes no more points than are allowed.
TEST(JoinedSight, LatticesDoNotSayWhatTheyDidNotSee) {
  const auto says_something = [](const Vec3& low, const Vec3& size, int max_points) {
    Scene scene;
    test::add_material(scene, 0.5, 0);
    add_tiles(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 1);
    add_tiles(scene, {0, 0, 2}, {0, 2, 0}, {2, 0, 0}, 1);
    add_box(scene, low, size, 1, true);
    const Sights sights(scene);
    const std::array<LatticePair, 1> pair = {LatticePair{1, {1e-2, 1e-2, max_points}}};
    return lattice_sight(sights.sight, 0, pair).front().has_value();
  };
  EXPECT_TRUE(says_something({.5, .7, .6}, {.8, .9, .7}, 300000));
  EXPECT_FALSE(says_something({.5, .7, .6}, {.8, .9, .7}, 15));
  EXPECT_FALSE(says_something({.5, .7, .6}, {.03, .03, .03}, 300000));
  EXPECT_FALSE(says_something({.5, .7, .6}, {.04, .04, .04}, 2000));
  EXPECT_FALSE(says_something({-5, -5, .6}, {12, 12, .7}, 300000));
}

/// A wall in tiles exchanges in sum what it does in one piece, behind the same things.
TEST(JoinedSight, TilesAddUpToTheWhole) {
  const auto scene = [](int n) {
    Scene result;
    test::add_material(result, 0.5, 0);
    add_tiles(result, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, n);
    add_tiles(result, {0, 0, 2}, {0, 2, 0}, {2, 0, 0}, n);
    add_box(result, {.7, .8, .6}, {.9, .5, .7}, n, true);
    return result;
  };
  const Sights whole(scene(1)), tiles(scene(4));
  const MutualSight expected = partial_sight(whole.sight, 0, 1, {1e-5, 1e-5, 300000});
  PointLooks looks(tiles.sight);
  double sum = 0, error = 0;
  for (int a = 0; a < 16; ++a)
    for (int b = 16; b < 32; ++b) {
      const Sight sight = sight_between(tiles.sight, a, b);
      if (sight == Sight::none) continue;
      const SightTolerance tolerance{1e-5, 1e-5 / 256, 300000};
      const MutualSight seen = sight == Sight::clear
                                   ? clear_sight(tiles.sight, a, b, tolerance)
                                   : partial_sight(tiles.sight, looks, a, b, tolerance);
      sum += seen.value;
      error += seen.error;
    }
  EXPECT_NEAR(sum, expected.value, expected.error + error);
  EXPECT_NEAR(sum, expected.value, 1e-5);
  EXPECT_GT(expected.value, 0.1);
}

}  // namespace
}  // namespace halfshade
