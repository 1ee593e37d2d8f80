#include "solver/factors/body_target.h"

#include "solver/direct/direct_light.h"
#include "solver/factors/body_pairs.h"
#include "solver/factors/body_sight.h"
#include "solver/factors/factor_matrix.h"
#include "solver/factors/factor_scene.h"
#include "tests/solver/factors/sight_points.h"
#include "tests/support/face_factors.h"
#include "tests/support/random.h"
#include "tests/support/round_things.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// The room by face, so that each side of a body is a surface.
struct Room {
  FactorScene factors = make_factor_scene(test::room_with_round_things(12), FactorUnit::face);
  SightScene sight = make_sight_scene(factors.sound);
  DirectLightIndex exact{factors.sound};
  std::vector<std::vector<int>> sides;  ///< of bodies

  Room() : sides(sight.bodies.size()) {
    for (int s = 0; s < surfaces(); ++s) {
      const int body = body_with(sight, s);
      if (body >= 0) sides[at(body)].push_back(s);
    }
  }
  int surfaces() const { return static_cast<int>(sight.surfaces.size()); }
  bool is_side(int surface, std::size_t body) const {
    return std::binary_search(sides[body].begin(), sides[body].end(), surface);
  }

  BodyTarget target(int surface, std::size_t body) const {
    std::vector<int> facing;
    for (const int side : sides[body])
      if (may_see(sight, surface, side)) facing.push_back(side);
    return {sight, surface, static_cast<int>(body), facing};
  }

  struct Seen {
    double all = 0, visible = 0;
  };
  /// Side by side.
  Seen seen(const Vec3& point, int surface, std::size_t body) const {
    Seen sum;
    for (const int side : sides[body]) {
      if (!may_see(sight, surface, side)) continue;
      const PointFactor factor =
          exact.factor({point, sight.surfaces[at(surface)].frame.normal}, side);
      sum.all += factor.unobstructed;
      sum.visible += factor.visible;
    }
    return sum;
  }
};

/// From everywhere: from the floor under what stands on it, from sides of other bodies, across
/// their horizon, past bodies, a sheet, and what lies behind.
TEST(BodyTarget, HidesWhatIsHiddenOfItsSides) {
  const Room room;
  ASSERT_EQ(room.sight.bodies.size(), 5u);
  test::Random random(7);
  int looks = 0, partly = 0, dark = 0, lit = 0, refused = 0;
  for (int a = 0; a < room.surfaces(); ++a) {
    const SightSurface& from = room.sight.surfaces[at(a)];
    for (std::size_t body = 0; body < room.sides.size(); ++body) {
      if (room.is_side(a, body)) continue;
      BodyTarget target = room.target(a, body);
      if (!target.is_applicable()) {
        ++refused;
        continue;
      }
      SharedShadows shadows(room.sight);
      for (int k = 0; k < 10; ++k) {
        const Vec3 point = test::point_of(from, random);
        shadows.move_to(point);
        HiddenFactor found;
        ASSERT_TRUE(target.hidden_factor(shadows.outlines(), found));
        const Room::Seen seen = room.seen(point, a, body);
        const double hidden = seen.all - seen.visible;
        EXPECT_NEAR(found.hidden, hidden, 1e-11) << "from " << a << " at body " << body;
        EXPECT_FALSE(found.is_dark && seen.visible > 1e-12) << "from " << a << " at body " << body;
        ++looks;
        partly += hidden > 1e-9 && seen.visible > 1e-9;
        dark += seen.all > 1e-9 && seen.visible < 1e-13;
        lit += seen.all > 1e-9 && hidden < 1e-13;
      }
    }
  }
  EXPECT_GT(looks, 1500);
  EXPECT_GT(partly, 300);
  EXPECT_GT(dark, 30);
  EXPECT_GT(lit, 300);
  EXPECT_LT(refused, 80);
}

/// Of parts of surfaces that are no larger than they are far off.
TEST(BodyTarget, NoPointBetweenCornersSeesMoreThanTheyTell) {
  const Room room;
  test::Random random(11);
  int cells = 0, bounded = 0, dark = 0;
  for (int a = 0; a < room.surfaces(); ++a) {
    const SightSurface& from = room.sight.surfaces[at(a)];
    if (from.outline.size() != 4) continue;
    for (std::size_t body = 0; body < room.sides.size(); ++body) {
      BodyTarget target = room.target(a, body);
      if (room.is_side(a, body) || !target.is_applicable()) continue;
      SharedShadows shadows(room.sight);
      for (int c = 0; c < 8; ++c) {
        const Vec3 middle = test::point_of(from, random);
        const double size = random(.02, .2);
        std::array<Vec3, 4> cell;
        for (std::size_t k = 0; k < 4; ++k) cell[k] = middle + size * (from.outline[k] - middle);
        const Ball ball = ball_round(cell), round = room.sight.bodies[body].ball;
        if (2 * ball.radius > (ball.centre - round.centre).norm() - ball.radius - round.radius)
          continue;
        const double most = target.seen_at_most(cell, shadows.outlines());
        double all = 0;
        for (int k = 0; k < 10; ++k) {
          const double s = random(0, 1), t = random(0, 1);
          const Vec3 point =
              (1 - t) * ((1 - s) * cell[0] + s * cell[1]) + t * ((1 - s) * cell[3] + s * cell[2]);
          const Room::Seen seen = room.seen(point, a, body);
          EXPECT_LE(seen.visible, 1.5 * most + 1e-12) << "from " << a << " at body " << body;
          all = std::max(all, seen.all);
        }
        ++cells;
        bounded += most < 0.5 * all;
        dark += most == 0 && all > 1e-9;
      }
    }
  }
  EXPECT_GT(cells, 1000);
  EXPECT_GT(bounded, 100);
  EXPECT_GT(dark, 20);
}

TEST(BodyTarget, NotWhereThingsMeetTheBodyOrEachOther) {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  for (const auto& face : test::box_faces(Vec3::Zero(), {4, 4, 4}, true))
    test::add_polygon(scene, face, 0);
  test::add_cylinder(scene, {{2, 2, 1}, .5, 2, 12, true}, 0);
  // Through the cylinder, and apart from it.
  test::add_polygon(scene, {{1, 1.8, 2}, {3, 1.8, 2.1}, {3, 2.2, 2.1}, {1, 2.2, 2}}, 0);
  const FactorScene factors = make_factor_scene(scene, FactorUnit::face);
  const SightScene sight = make_sight_scene(factors.sound);
  ASSERT_EQ(sight.bodies.size(), 1u);
  std::vector<int> sides;
  for (int s = 0; s < static_cast<int>(sight.surfaces.size()); ++s)
    if (body_with(sight, s) == 0) sides.push_back(s);
  EXPECT_FALSE(BodyTarget(sight, 0, 0, sides).is_applicable());
}

std::vector<JoinedPairs> pairs_by(FactorUnit unit) {
  const FactorScene factors = make_factor_scene(test::room_with_round_things(12), unit);
  const SightScene sight = make_sight_scene(factors.sound);
  const auto pairs = find_pairs(factors, sight, {});
  auto joined = find_body_pairs(sight, pairs, sides_of_bodies(factors, sight));
  std::set<std::pair<int, std::size_t>> parts;
  for (const JoinedPairs& body : joined)
    for (const auto& [low, place] : body.parts) {
      EXPECT_TRUE(parts.emplace(low, place).second) << "a part of two";
      const SightPair& pair = pairs[at(low)][place];
      EXPECT_EQ(pair.sight, Sight::partial);
      const int side = low == body.whole.surface ? pair.other : low;
      EXPECT_EQ(body_with(sight, side), body.whole.body);
    }
  return joined;
}

TEST(BodyPairs, OfBodiesThatHaveOneRow) {
  EXPECT_GT(pairs_by(FactorUnit::material).size(), 20u);
  EXPECT_TRUE(pairs_by(FactorUnit::face).empty());
}

/// By material, where bodies are looked at as wholes, and by face, where they are not: the same,
/// and 19 times as quick.
TEST(BodyPairs, AddUpToWhatTheirSidesDo) {
  const Scene scene = test::room_with_round_things(12);
  const FactorMatrix faces = test::face_factors(scene, 1e-5);
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    const FactorMatrix matrix = test::material_factors(scene, tolerance);
    EXPECT_EQ(matrix.report.rows_not_reached, 0);
    EXPECT_LT(matrix.report.row_sum_error_max, tolerance);
    for (Eigen::Index i = 0; i < matrix.area.size(); ++i)
      for (Eigen::Index j = 0; j < matrix.area.size(); ++j) {
        double sum = 0, error = 0;
        for (std::size_t a = 0; a < scene.faces.size(); ++a)
          for (std::size_t b = 0; b < scene.faces.size(); ++b) {
            const auto p = static_cast<Eigen::Index>(a), q = static_cast<Eigen::Index>(b);
            if (scene.faces[a].material != i || scene.faces[b].material != j) continue;
            sum += faces.area[p] * faces.factors(p, q) / matrix.area[i];
            error = std::max(error, faces.error[p]);
          }
        EXPECT_NEAR(matrix.factors(i, j), sum, matrix.error[i] + error) << i << " " << j;
      }
  }
}

/// (Side by side it is 80,000.)
TEST(BodyPairs, TakeFewPoints) {
  const FactorMatrix matrix = test::material_factors(test::room_with_balls(3, 2), 1e-4);
  EXPECT_EQ(matrix.report.rows_not_reached, 0);
  EXPECT_LT(matrix.report.points, 45000u);
}

/// What stands on a floor without a bottom shuts in a disc of it: all that leaves the disc arrives
/// at the inside, whatever is asked for.
TEST(BodyPairs, FloorsUnderOpenCylindersSeeTheirInside) {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  for (const auto& face : test::box_faces(Vec3::Zero(), {6, 4, 3}, true))
    test::add_polygon(scene, face, 0);
  const int faces = 32;
  test::add_cylinder(scene, {{1, 1.5, 0}, .5, 1.7, faces}, 0);
  test::add_cylinder(scene, {{4, 2, 0}, .4, 2, faces}, 0);
  const FactorMatrix matrix = test::face_factors(scene, 1e-2);
  const double of_unit = faces / 2. * std::sin(2 * std::numbers::pi / faces);
  const double discs = of_unit * (.5 * .5 + .4 * .4);
  const Eigen::Index floor = 4;
  ASSERT_NEAR(matrix.area[floor], 24, 1e-9);
  EXPECT_NEAR(matrix.backs[floor], discs / 24, 1e-10);
}

}  // namespace
}  // namespace halfshade
