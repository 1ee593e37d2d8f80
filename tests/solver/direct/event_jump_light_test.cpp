#include "meshing/discontinuity/event_jump.h"
#include "solver/direct/direct_light.h"
#include "tests/support/sound_scenes.h"

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace halfshade {
namespace {

using test::Random;

/// What the exact form factor does on both sides of a point.
struct Jump {
  double value = 0, first = 0, second = 0;
  double second_in_closed_form = 0;  ///< from the solver's derivatives
};

constexpr int nodes = 11;

/// Fits a polynomial to values at `nodes` places in (0, 1] and returns its coefficients.
Eigen::VectorXd polynomial(const Eigen::VectorXd& places, const Eigen::VectorXd& values) {
  Eigen::MatrixXd powers(nodes, nodes);
  for (int i = 0; i < nodes; ++i)
    for (int k = 0; k < nodes; ++k) powers(i, k) = std::pow(places[i], k);
  return powers.colPivHouseholderQr().solve(values);
}

/// One-sided derivatives of the form factor to receiver 0 by polynomials of degree 10 over a
/// stretch h; nothing if other events lie within it.
std::optional<Jump> jump_at(const DirectLightIndex& index, const ReceivingPoint& at, double h) {
  std::array<Eigen::VectorXd, 2> series, curvature;
  for (std::size_t side = 0; side < 2; ++side) {
    Eigen::VectorXd places(nodes), values(nodes), seconds(nodes);
    std::uint64_t signature = 0;
    for (int i = 0; i < nodes; ++i) {  // Chebyshev's, from 0 to 1
      places[i] = 0.5 - 0.5 * std::cos(std::numbers::pi * (i + 0.5) / nodes);
      const Vec3 p = at.position + (side == 0 ? -h : h) * places[i] * at.across;
      const PointFactorDerivatives f = index.factor_derivatives({p, at.normal}, 0);
      values[i] = f.factor.visible;
      seconds[i] = at.across.dot(f.hessian * at.across);
      if (i > 0 && signature != f.factor.signature) return std::nullopt;
      signature = f.factor.signature;
    }
    series[side] = polynomial(places, values);
    curvature[side] = polynomial(places, seconds);
  }
  return Jump{series[1][0] - series[0][0], (series[1][1] + series[0][1]) / h,
              2 * (series[1][2] - series[0][2]) / (h * h), curvature[1][0] - curvature[0][0]};
}

/// The same over a stretch on which the polynomials have converged: half of it gives the same.
std::optional<Jump> resolved_jump_at(const DirectLightIndex& index, const ReceivingPoint& at) {
  for (const double h : {0.2, 0.1, 0.05, 0.025}) {
    const std::optional<Jump> jump = jump_at(index, at, h), half = jump_at(index, at, h / 2);
    if (jump && half && std::abs(jump->first - half->first) < 1e-9 &&
        std::abs(jump->second - half->second) < 4e-6 * std::abs(jump->second) &&
        std::abs(jump->second_in_closed_form - half->second_in_closed_form) < 1e-9)
      return jump;
  }
  return std::nullopt;
}

/// A random light, its corners, and room for occluders.
struct Stage {
  SoundScene scene = test::empty_sound_scene(5);
  std::vector<Vec3> corners;
  PlaneFrame light;
  ReceivingPoint at;

  explicit Stage(Random& random) {
    for (const Vec2& q : {Vec2(-1, -1), Vec2(-1, 1), Vec2(1, 1), Vec2(1, -1)})
      corners.push_back({q.x() * random(0.6, 1), q.y() * random(0.6, 1), 2});
    test::add_surface(scene, {corners}, 1);
    light = scene.surfaces[0].frame;
    at.normal = Vec3::UnitZ();
    const double angle = random(0, 6);
    at.across = {std::cos(angle), std::sin(angle), 0};
  }

  Vec3 on_edge(std::size_t k, double s) const {
    return corners[k] + s * (corners[(k + 1) % 4] - corners[k]);
  }
  Line3 edge(std::size_t k) const {
    return {corners[k % 4], corners[(k + 1) % 4] - corners[k % 4]};
  }
  /// A half-plane, nearly: a wide square with the middle of one edge at x, the edge level enough to
  /// reach over all of the light. Returns the line of the edge.
  Line3 add_bar(Random& random, const Vec3& x) {
    const double angle = random(0, 6);
    const Vec3 along(std::cos(angle), std::sin(angle), random(-0.05, 0.05));
    const Vec3 side(-std::sin(angle), std::cos(angle), random(-0.05, 0.05));
    test::add_surface(
        scene, {{x - 4 * along, x + 4 * along, x + 4 * along + 4 * side, x - 4 * along + 4 * side}},
        0);
    return {x, along};
  }
  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    test::add_surface(scene, {{a, b, c}}, 0);
  }
  /// Puts the point where the line from q through x meets the floor.
  void look(const Vec3& q, const Vec3& x) {
    at.position = q + q.z() / (q.z() - x.z()) * (x - q);
    at.position.z() = 0;
  }
};

/// Compares jump and prediction; returns whether the surroundings allowed it.
bool compare(const Stage& stage, const std::array<Line3, 3>& lines) {
  const DirectLightIndex index(stage.scene);
  const double expected = triangle_jump(stage.at, stage.light, lines);
  // Where the triangle hardly grows other terms take over; rounding is 1e-16/h² and more.
  if (!(expected > 0.01) || expected > 10) return false;
  const std::optional<Jump> jump = resolved_jump_at(index, stage.at);
  if (!jump) return false;
  EXPECT_NEAR(jump->value, 0, 1e-11);
  EXPECT_NEAR(jump->first, 0, 1e-9);
  EXPECT_NEAR(std::abs(jump->second), expected, 5e-6 * expected);
  EXPECT_NEAR(std::abs(jump->second_in_closed_form), expected, 1e-7 * expected);
  return true;
}

/// Compares on random stages, where `arrange` adds occluders of which three lines are seen to meet
/// from the point, and returns these.
template <class Arrange>
void compare_many(std::uint64_t seed, const Arrange& arrange) {
  Random random(seed);
  int compared = 0;
  for (int round = 0; round < 200; ++round) {
    Stage stage(random);
    const std::array<Line3, 3> lines = arrange(random, stage);
    compared += compare(stage, lines);
  }
  EXPECT_GT(compared, 60);
}

TEST(EventJumpOfTheFormFactor, WhereAnOccludersVertexPassesAnEmittersEdge) {
  compare_many(21, [](Random& random, Stage& stage) -> std::array<Line3, 3> {
    const Vec3 vertex = random.in_box({-0.3, -0.3, 0.8}, {0.3, 0.3, 1.2});
    const Vec3 b = vertex + 2 * random.direction().cwiseProduct(Vec3(1, 1, 0.1));
    const Vec3 c = vertex + 2 * random.direction().cwiseProduct(Vec3(1, 1, 0.1));
    stage.add_triangle(vertex, b, c);
    stage.look(stage.on_edge(0, random(0.2, 0.8)), vertex);
    return {Line3{vertex, b - vertex}, Line3{vertex, c - vertex}, stage.edge(0)};
  });
}

TEST(EventJumpOfTheFormFactor, WhereAnEmittersVertexPassesAnOccludersEdge) {
  compare_many(22, [](Random& random, Stage& stage) -> std::array<Line3, 3> {
    const Vec3 x = random.in_box({-0.3, -0.3, 0.8}, {0.3, 0.3, 1.2});
    const Line3 bar = stage.add_bar(random, x);
    stage.look(stage.corners[1], x);
    return {bar, stage.edge(0), stage.edge(1)};
  });
}

TEST(EventJumpOfTheFormFactor, WhereTwoEdgesPassAnEmittersEdge) {
  compare_many(23, [](Random& random, Stage& stage) -> std::array<Line3, 3> {
    const Vec3 q = stage.on_edge(2, random(0.2, 0.8));
    const Vec3 x = random.in_box({-0.3, -0.3, 0.6}, {0.3, 0.3, 0.8});
    const Line3 low = stage.add_bar(random, x);
    const Line3 high = stage.add_bar(random, 0.5 * (x + q));
    stage.look(q, x);
    return {low, high, stage.edge(2)};
  });
}

TEST(EventJumpOfTheFormFactor, WhereThreeEdgesPassEachOther) {
  compare_many(24, [](Random& random, Stage& stage) -> std::array<Line3, 3> {
    const Vec3 q = random.in_box({-0.4, -0.4, 2}, {0.4, 0.4, 2});
    const Vec3 x = random.in_box({-0.3, -0.3, 0.6}, {0.3, 0.3, 0.7});
    const Line3 low = stage.add_bar(random, x);
    const Line3 middle = stage.add_bar(random, x + 0.35 * (q - x));
    const Line3 high = stage.add_bar(random, x + 0.7 * (q - x));
    stage.look(q, x);
    return {low, middle, high};
  });
}

TEST(EventJumpOfTheFormFactor, WhereAnEdgeIsSeenAlongAnEmittersEdge) {
  // The occluder's edge lies in the plane of the point and an edge of the light and covers all of
  // the light's edge: the first derivative jumps by what its image sweeps there.
  Random random(25);
  int compared = 0;
  for (int round = 0; round < 200; ++round) {
    Stage stage(random);
    const Vec3 a = stage.corners[3], b = stage.corners[0];
    stage.at.position = random.in_box({-0.5, -0.5, 0}, {0.5, 0.5, 0});
    const Vec3 p = stage.at.position;
    const Vec3 from = p + random(0.3, 0.6) * (a - p), to = p + random(0.3, 0.6) * (b - p);
    const Vec3 along = to - from;
    const Vec3 side = 4 * Vec3(0, random(-1, 1) < 0 ? 1 : -1, random(-0.1, 0.1));
    const Vec3 start = from - 0.7 * along, end = to + 0.7 * along;
    test::add_surface(stage.scene, {{start, end, end + side, start + side}}, 0);
    const DirectLightIndex index(stage.scene);
    const double expected = std::abs(boundary_motion(stage.at, stage.light, from, to));
    const std::optional<Jump> jump = resolved_jump_at(index, stage.at);
    if (!jump || expected < 1e-3) continue;
    ++compared;
    EXPECT_NEAR(jump->value, 0, 1e-11);
    EXPECT_NEAR(std::abs(jump->first), expected, 1e-7 * expected) << round;
  }
  EXPECT_GT(compared, 60);
}

}  // namespace
}  // namespace halfshade
