#include "solver/direct/direct_light.h"
#include "tests/support/sound_scenes.h"
#include "tests/support/visibility_oracle.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace halfshade {
namespace {

using test::Random;

constexpr int points_per_scene = 200;

/// Light that comes in a sliver right at the horizon has less than this of a form factor, and its
/// relative accuracy ends where the rounding of the normal moves the horizon.
constexpr double horizon_sliver = 1e-17;

/// What makes a family of random scenes hard.
enum class Family {
  polygons,     ///< floating convex polygons
  boxes,        ///< floating boxes
  standing,     ///< boxes that touch the surface, points right beside them
  hanging,      ///< boxes that touch the emitter
  overlapping,  ///< occluders that overlap each other in one plane
  edge_on,      ///< points in the planes of the occluders' faces and edges
  horizon,      ///< the horizon cuts the emitter
  holed,        ///< a light that is not convex and has a hole
  walls,        ///< occluders that share edges and stand on the floor below a vertical light
  everything,
};
constexpr int families = 10;

struct Case {
  SoundScene scene = test::empty_sound_scene(6);
  int emitter = 0;
  std::vector<SurfacePoint> points;
};

void add_box(SoundScene& scene, const std::array<std::vector<Vec3>, 6>& faces) {
  for (const auto& face : faces) test::add_surface(scene, {face}, 0);
}

/// Multiples of 1/8 keep coordinates exact, so that what should touch touches.
Vec3 on_grid(const Vec3& p) { return (p * 8).array().round() / 8; }

/// A box whose corners lie on the grid, between z = low and high if they are given.
void add_grid_box(SoundScene& scene, Random& random, double low, double high) {
  const Vec3 a = on_grid(random.in_box({-2, -2, 0.5}, {2, 2, 1.5}));
  const Vec3 size = on_grid(random.in_box(Vec3::Constant(0.2), Vec3::Constant(0.8)));
  Vec3 from = a, to = a + size;
  if (low >= 0) from.z() = low;
  if (high >= 0) to.z() = high;
  add_box(scene, test::box_faces(from, to, false));
}

void add_occluders(Case& c, Family family, Random& random) {
  SoundScene& scene = c.scene;
  const auto floating = [&] { return random.in_box({-1.5, -1.5, 0.6}, {1.5, 1.5, 2}); };
  switch (family) {
    case Family::polygons:
    case Family::horizon:
    case Family::holed:
      for (int k = 0; k < 8; ++k)
        test::add_surface(
            scene, {test::random_polygon(random, floating(), random.direction(), random(0.1, 0.6))},
            0);
      return;
    case Family::boxes:
      for (int k = 0; k < 3; ++k) add_box(scene, test::random_box(random, floating(), 0.4));
      return;
    case Family::standing:
      for (int k = 0; k < 3; ++k) add_grid_box(scene, random, 0, -1);
      return;
    case Family::hanging:
      for (int k = 0; k < 3; ++k) add_grid_box(scene, random, -1, 2.5);
      return;
    case Family::overlapping:
      for (int k = 0; k < 8; ++k)
        test::add_surface(scene,
                          {test::random_polygon(random, random.in_box({-1, -1, 1.25}, {1, 1, 1.25}),
                                                k % 2 ? Vec3::UnitZ() : Vec3(-Vec3::UnitZ()), 0.5)},
                          0);
      return;
    case Family::edge_on:
      for (int k = 0; k < 3; ++k) add_grid_box(scene, random, -1, -1);
      return;
    case Family::walls:
      for (int k = 0; k < 6; ++k) {
        const Vec3 a = on_grid(random.in_box({-2, -1.5, 0}, {2, 1.5, 0}));
        const Vec3 b = on_grid(random.in_box({-2, -1.5, 0}, {2, 1.5, 0}));
        const Vec3 up(0, 0, 0.125 * random.integer(2, 12));
        if (a != b) test::add_surface(scene, {{a, b, b + up, a + up}}, 0);
      }
      return;
    case Family::everything:
      add_box(scene, test::random_box(random, floating(), 0.3));
      add_grid_box(scene, random, 0, -1);
      add_grid_box(scene, random, -1, 2.5);
      for (int k = 0; k < 4; ++k)
        test::add_surface(
            scene, {test::random_polygon(random, floating(), random.direction(), random(0.1, 0.6))},
            0);
  }
}

void add_light(Case& c, Family family, Random& random) {
  const double z = 2.5;
  if (family == Family::holed) {
    const auto p = [&](double x, double y) { return Vec3(x, y, z); };
    // An L with a square hole, seen from below.
    test::add_surface(c.scene,
                      {{p(-1, -1), p(-1, 1), p(0.25, 1), p(0.25, 0.125), p(1, 0.125), p(1, -1)},
                       {p(-0.75, -0.75), p(-0.25, -0.75), p(-0.25, -0.25), p(-0.75, -0.25)}},
                      1);
  } else if (family == Family::walls) {
    test::add_surface(c.scene, {{{-1, 2, 0}, {1, 2, 0}, {1, 2, 1.5}, {-1, 2, 1.5}}}, 1);
  } else if (family == Family::horizon || family == Family::polygons) {
    const Vec3 centre = random.in_box({-1, -1, z}, {1, 1, z});
    const Vec3 tilt = 0.4 * random.direction();
    test::add_surface(
        c.scene, {test::random_polygon(random, centre, tilt - Vec3::UnitZ(), random(0.3, 1))}, 1);
  } else {
    test::add_surface(c.scene, {{{-1, -1, z}, {-1, 1, z}, {1, 1, z}, {1, -1, z}}}, 1);
  }
}

SurfacePoint random_point(Family family, Random& random) {
  Vec3 p = random.in_box({-3, -3, 0}, {3, 3, 0});
  Vec3 n = Vec3::UnitZ();
  if (family == Family::horizon || family == Family::everything) {
    p.z() = random(0, 0.4);
    n = (random.direction() + 0.3 * Vec3::UnitZ()).normalized();
  }
  // The planes of faces on the grid pass through points on the grid.
  if (family == Family::edge_on) {
    p.z() = random(0, 1.5);
    const Vec3 grid = on_grid(p);
    const int which = random.integer(1, 7);
    for (int k = 0; k < 3; ++k)
      if (which & (1 << k)) p[k] = grid[k];
  }
  return {p, n};
}

Case make_case(int seed) {
  Random random(static_cast<std::uint64_t>(seed));
  const auto family = static_cast<Family>(seed % families);
  Case c;
  add_light(c, family, random);
  const std::vector<Vec3> floor = {{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}};
  test::add_surface(c.scene, {floor}, 0);
  add_occluders(c, family, random);
  for (int k = 0; k < points_per_scene; ++k) c.points.push_back(random_point(family, random));
  return c;
}

class RandomScene : public testing::TestWithParam<int> {};

TEST_P(RandomScene, AgreesWithReclippingInLongDouble) {
  const Case c = make_case(GetParam());
  const DirectLightIndex index(c.scene);
  const test::VisibilityOracle oracle(c.scene);
  int penumbra = 0;
  for (const SurfacePoint& point : c.points) {
    const PointFactor factor = index.factor(point, c.emitter);
    const test::OracleAnswer want = oracle.form_factor(point.position, point.normal, c.emitter);
    const double visible = static_cast<double>(want.visible);
    const double whole = static_cast<double>(want.unobstructed);
    const std::string where =
        fmt::format("at {:.17g} {:.17g} {:.17g}, normal {:.17g} {:.17g} {:.17g}",
                    point.position.x(), point.position.y(), point.position.z(), point.normal.x(),
                    point.normal.y(), point.normal.z());
    EXPECT_NEAR(factor.unobstructed, whole, std::max(1e-10 * whole, horizon_sliver)) << where;
    EXPECT_NEAR(factor.visible, visible, std::max({1e-10 * visible, 1e-13 * whole, horizon_sliver}))
        << where;
    EXPECT_GE(factor.visible, 0) << where;
    EXPECT_LE(factor.visible, factor.unobstructed) << where;
    if (factor.region == Region::lit) {
      EXPECT_EQ(factor.visible, factor.unobstructed) << where;
    }
    if (factor.region == Region::umbra) {
      EXPECT_EQ(factor.visible, 0) << where;
    }
    if (factor.region == Region::penumbra) ++penumbra;
  }
  EXPECT_GT(penumbra, 0) << "the scene tests nothing";
}

INSTANTIATE_TEST_SUITE_P(FiftyScenes, RandomScene, testing::Range(0, 50));

}  // namespace
}  // namespace halfshade
