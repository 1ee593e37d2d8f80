#include "meshing/discontinuity/event_jump.h"

#include "meshing/core/planar.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace halfshade {
namespace {

using test::Random;

/// A light at height z that looks down.
PlaneFrame light_at(double z) { return make_frame({0, 0, z}, -Vec3::UnitZ()); }

ReceivingPoint on_floor(double x, double y, const Vec3& across) {
  return {{x, y, 0}, Vec3::UnitZ(), across};
}

Line3 line_through(const Vec3& a, const Vec3& b) { return {a, b - a}; }

/// Where the plane of a point and a line cuts the emitter: coefficients of a x + b y + c = 0 in the
/// emitter's coordinates.
Vec3 image(const Vec3& point, const PlaneFrame& emitter, const Line3& line) {
  const Vec3 n = (line.point - point).cross(line.direction);
  return {n.dot(emitter.e1), n.dot(emitter.e2), n.dot(emitter.origin - point)};
}

/// Area between the images of three lines.
double triangle_area(const Vec3& point, const PlaneFrame& emitter,
                     const std::array<Line3, 3>& lines) {
  std::array<Vec2, 3> corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = image(point, emitter, lines[i])
                     .cross(image(point, emitter, lines[(i + 1) % 3]))
                     .hnormalized();
  const Vec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
  return 0.5 * std::abs(cross_2d(a, b));
}

double kernel(const ReceivingPoint& at, const PlaneFrame& emitter, const Vec3& q) {
  const Vec3 w = q - at.position;
  return at.normal.dot(w) * -emitter.normal.dot(w) /
         (std::numbers::pi * w.squaredNorm() * w.squaredNorm());
}

/// ∫ K v dl by Simpson's rule along the image, the motion by differences of images.
double motion_by_simpson(const ReceivingPoint& at, const PlaneFrame& emitter, const Vec3& from,
                         const Vec3& to) {
  const auto seen = [&](const Vec3& point, const Vec3& x) {
    const double height = emitter.height(point);
    return Vec3(point + height / (height - emitter.height(x)) * (x - point));
  };
  const Vec3 a = seen(at.position, from), b = seen(at.position, to);
  // The viewer sees the emitter from its front: right of the direction from a to b.
  const Vec3 right = (b - a).cross(emitter.normal).normalized();
  const auto integrand = [&](double s) {
    const Vec3 q = a + s * (b - a);
    constexpr double step = 1e-4;
    const auto offset = [&](double t) {
      const Vec3 point = at.position + t * at.across;
      const Vec3 c = seen(point, from), along = seen(point, to) - c;
      // The image moved by y along `right`: (q + y right − c) × along = 0.
      const Vec3 n = along.cross(emitter.normal);
      return n.dot(c - q) / n.dot(right);
    };
    const double fine = (offset(step / 2) - offset(-step / 2)) / step;
    const double coarse = (offset(step) - offset(-step)) / (2 * step);
    return kernel(at, emitter, q) * (4 * fine - coarse) / 3;
  };
  constexpr int panels = 200;
  double sum = 0;
  for (int i = 0; i < panels; ++i)
    sum += integrand(i / double(panels)) + 4 * integrand((i + 0.5) / panels) +
           integrand((i + 1.0) / panels);
  return sum * (b - a).norm() / (6 * panels);
}

struct Configuration {
  ReceivingPoint at;
  PlaneFrame emitter;
  Vec3 meeting;  ///< on the emitter
  std::array<Line3, 3> lines;
};

/// A tilted emitter, a tilted receiver, and three lines that meet the same ray in between.
Configuration random_configuration(Random& random) {
  Configuration c;
  c.emitter =
      make_frame(random.in_box({-1, -1, 2}, {1, 1, 3}), -Vec3::UnitZ() + 0.3 * random.direction());
  c.at.position = random.in_box({-1, -1, -0.2}, {1, 1, 0.2});
  c.at.normal = (Vec3::UnitZ() + 0.5 * random.direction()).normalized();
  c.at.across = make_frame(c.at.position, c.at.normal).e1;
  c.meeting = c.emitter.to_space({random(-0.5, 0.5), random(-0.5, 0.5)});
  for (Line3& line : c.lines) {
    const Vec3 x = c.at.position + random(0.2, 0.9) * (c.meeting - c.at.position);
    const Vec3 d = random(0.2, 3) * random.direction();
    line = {x + random(-2, 2) * d, d};
  }
  return c;
}

// The table of closed forms in high precision that other programs agreed on, six digits.
TEST(EventJump, OccluderVertexAgainstEmitterEdge) {
  const Vec3 vertex(0.9, 0.2, 1);
  const double jump =
      triangle_jump(on_floor(2.3, 0.4, Vec3::UnitX()), light_at(2),
                    {line_through({0.1, -0.6, 1}, vertex), line_through(vertex, {0.2, 0.7, 1}),
                     line_through({-0.5, -0.5, 2}, {-0.5, 0.5, 2})});
  EXPECT_NEAR(jump, 1.515761e-2, 5e-9);
}

TEST(EventJump, EmitterVertexAgainstOccluderEdge) {
  const Vec3 across = Vec3(0.5, 0.7, 0).normalized();
  const double jump = triangle_jump(
      on_floor(0.74, 0.3, across), light_at(2),
      {line_through({0.9, 0.2, 1}, {0.2, 0.7, 1}), line_through({0.5, -0.5, 2}, {0.5, 0.5, 2}),
       line_through({0.5, 0.5, 2}, {-0.5, 0.5, 2})});
  EXPECT_NEAR(0.74 * jump, 1.186442e-1, 5e-8);  // tabulated for a direction of length √0.74
}

TEST(EventJump, TwoSkewEdgesAndAnEmitterEdge) {
  const double jump =
      triangle_jump(on_floor(0.1, -0.3, Vec3::UnitX()), light_at(2),
                    {Line3{{0, 0, 1}, {1, 1, 0}}, Line3{{0.1, 0, 0.75}, {1, -1, 0.1}},
                     line_through({0.5, 0.5, 2}, {-0.5, 0.5, 2})});
  EXPECT_NEAR(jump, 1.339969e-2, 5e-9);
}

TEST(EventJump, OfParallelEdgesAtTheOuterPenumbraAndAtTheUmbra) {
  // Images of the occluder's edge x = 0.375 on the light's edges x = ∓0.5; what of it hides the
  // light spans half of the light's y − y(point). Visible is what lies at smaller x.
  const double outer = boundary_motion(on_floor(1.25, 0, Vec3::UnitX()), light_at(2),
                                       {0.375, 0.25, 1}, {0.375, -0.25, 1});
  EXPECT_NEAR(std::abs(outer), 2.494278e-2, 5e-9);
  const double umbra = boundary_motion(on_floor(0.25, 0.05, Vec3::UnitX()), light_at(2),
                                       {0.375, -0.225, 1}, {0.375, 0.275, 1});
  EXPECT_NEAR(umbra, 7.406901e-2, 5e-9);
}

TEST(EventJump, MotionIsTowardsTheHiddenSide) {
  // Seen from below, the piece runs along +y at x = 0.375. Looking up with +y ahead, +x is on the
  // left. A point that moves along +x sees the image move along −x: to the right.
  const ReceivingPoint at = on_floor(0.25, 0, Vec3::UnitX());
  EXPECT_GT(boundary_motion(at, light_at(2), {0.375, -0.2, 1}, {0.375, 0.2, 1}), 0);
  EXPECT_LT(boundary_motion(at, light_at(2), {0.375, 0.2, 1}, {0.375, -0.2, 1}), 0);
}

TEST(EventJump, IsTheKernelTimesTheGrowthOfTheTriangle) {
  Random random(11);
  for (int round = 0; round < 300; ++round) {
    const Configuration c = random_configuration(random);
    const auto growth = [&](double t) {  // 2 A(t)/t²: even differences, error O(t²)
      const Vec3 step = t * c.at.across;
      return (triangle_area(c.at.position + step, c.emitter, c.lines) +
              triangle_area(c.at.position - step, c.emitter, c.lines)) /
             (t * t);
    };
    const double expected =
        kernel(c.at, c.emitter, c.meeting) * (4 * growth(5e-5) - growth(1e-4)) / 3;
    const double got = triangle_jump(c.at, c.emitter, c.lines);
    // Slim triangles grow unevenly within the step of the differences.
    double slim = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2 a = image(c.at.position, c.emitter, c.lines[i]).head<2>().normalized();
      const Vec2 b = image(c.at.position, c.emitter, c.lines[(i + 1) % 3]).head<2>().normalized();
      slim = std::min(slim, std::abs(cross_2d(a, b)));
    }
    if (slim < 0.05) continue;
    EXPECT_NEAR(got, expected, 1e-5 * expected + 1e-7) << round;
  }
}

TEST(EventJump, DoesNotDependOnHowLinesAreGiven) {
  Random random(12);
  for (int round = 0; round < 200; ++round) {
    const Configuration c = random_configuration(random);
    const double jump = triangle_jump(c.at, c.emitter, c.lines);
    std::array<Line3, 3> other = {c.lines[2], c.lines[0], c.lines[1]};
    for (Line3& line : other) {
      line.point += random(-1, 1) * line.direction;
      line.direction *= random(0.1, 2) * (random(-1, 1) < 0 ? -1 : 1);
    }
    EXPECT_NEAR(triangle_jump(c.at, c.emitter, other), jump, 1e-9 * jump) << round;
  }
}

TEST(EventJump, ScalesWithTheSceneAndTurnsWithIt) {
  Random random(13);
  for (int round = 0; round < 100; ++round) {
    const Configuration c = random_configuration(random);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random(0, 6), random.direction()).toRotationMatrix();
    const Vec3 shift = random.in_box({-5, -5, -5}, {5, 5, 5});
    constexpr double scale = 4;
    const auto moved = [&](const Vec3& p) { return Vec3(scale * (turn * p) + shift); };
    const ReceivingPoint at = {moved(c.at.position), turn * c.at.normal, turn * c.at.across};
    const PlaneFrame emitter = make_frame(moved(c.emitter.origin), turn * c.emitter.normal);
    std::array<Line3, 3> lines = c.lines;
    for (Line3& line : lines) line = {moved(line.point), turn * line.direction};
    const double jump = triangle_jump(c.at, c.emitter, c.lines);
    EXPECT_NEAR(triangle_jump(at, emitter, lines) * scale * scale, jump, 1e-8 * jump);
    const Vec3 a = random.in_box({-1, -1, 0.7}, {1, 1, 1.2});
    const Vec3 b = random.in_box({-1, -1, 0.7}, {1, 1, 1.2});
    const double motion = boundary_motion(c.at, c.emitter, a, b);
    EXPECT_NEAR(boundary_motion(at, emitter, moved(a), moved(b)) * scale, motion,
                1e-10 * (1 + std::abs(motion)));
  }
}

TEST(EventJump, IsInfiniteIfTwoLinesCoincideAndZeroIfAllDo) {
  const PlaneFrame light = light_at(2);
  const ReceivingPoint at = on_floor(0, 0, Vec3::UnitX());
  const Line3 a = {{0.5, -1, 1}, {0, 1, 0}}, over_a = {{1, 3, 2}, {0, 2, 0}};
  const Line3 third_of_a = {{0.25, 0, 0.5}, {0, 0.3, 0}}, b = {{0, 0.1, 1.5}, {1, 0.2, 0}};
  EXPECT_EQ(triangle_jump(at, light, {a, over_a, b}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(triangle_jump(at, light, {b, a, over_a}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(triangle_jump(at, light, {a, over_a, third_of_a}), 0);
}

TEST(EventJump, IsZeroWhereNoLightArrives) {
  Random random(14);
  Configuration c = random_configuration(random);
  ASSERT_GT(triangle_jump(c.at, c.emitter, c.lines), 0);
  ReceivingPoint below = c.at;
  below.normal = -below.normal;
  EXPECT_EQ(triangle_jump(below, c.emitter, c.lines), 0);
  EXPECT_EQ(triangle_jump(c.at, make_frame(c.emitter.origin, -c.emitter.normal), c.lines), 0);
}

TEST(EventJump, LinesThroughOneVertexThatAllStayInLineGiveNothing) {
  // Moving towards the common vertex of all three lines keeps the images concurrent.
  const ReceivingPoint at = on_floor(1, 0, Vec3::UnitX());
  const Vec3 vertex(0.2, 0.1, 1);
  const double jump = triangle_jump(
      at, light_at(2),
      {Line3{vertex, {1, 0, 0}}, Line3{vertex, {0, 1, 0}}, Line3{vertex, {1, 1, 0.3}}});
  EXPECT_NEAR(jump, 0, 1e-28);
}

TEST(BoundaryMotion, IsTheIntegralAlongTheImage) {
  Random random(15);
  for (int round = 0; round < 60; ++round) {
    const Configuration c = random_configuration(random);
    const Vec3 a = random.in_box({-1, -1, 0.7}, {1, 1, 1.3});
    const Vec3 b = random.in_box({-1, -1, 0.7}, {1, 1, 1.3});
    const double expected = motion_by_simpson(c.at, c.emitter, a, b);
    EXPECT_NEAR(boundary_motion(c.at, c.emitter, a, b), expected, 1e-8 * (1 + std::abs(expected)));
  }
}

TEST(BoundaryMotion, AddsUpOverPartsOfAnEdge) {
  // Also where the angles are so small that other terms of the closed form count.
  Random random(16);
  for (int round = 0; round < 200; ++round) {
    const Configuration c = random_configuration(random);
    const Vec3 a = random.in_box({-1, -1, 0.7}, {1, 1, 1.3});
    const Vec3 b = a + std::pow(10, random(-5, 0)) * random.direction();
    const double whole = boundary_motion(c.at, c.emitter, a, b);
    double sum = 0;
    constexpr int parts = 7;
    for (int i = 0; i < parts; ++i)
      sum += boundary_motion(c.at, c.emitter, a + i / double(parts) * (b - a),
                             a + (i + 1) / double(parts) * (b - a));
    EXPECT_NEAR(sum, whole, 1e-9 * std::abs(whole) + 1e-15) << round;
    EXPECT_NEAR(boundary_motion(c.at, c.emitter, b, a), -whole, 1e-12 * std::abs(whole));
  }
}

TEST(BoundaryMotion, IsZeroForEdgesInTheEmittersPlaneOrSeenEndOn) {
  const ReceivingPoint at = on_floor(0.3, -0.2, Vec3::UnitX());
  EXPECT_EQ(boundary_motion(at, light_at(2), {0.5, -0.5, 2}, {0.5, 0.5, 2}), 0);
  EXPECT_EQ(boundary_motion(on_floor(0, 0, Vec3::UnitX()), light_at(2), {0, 0, 1}, {0, 0, 1.5}), 0);
}

TEST(BoundaryMotion, StaysExactNearTheEmitter) {
  // A point 1e-3 below a long edge just under the light; the image is resolved into small parts.
  const ReceivingPoint at = {{0, 0, 1.999}, Vec3::UnitZ(), Vec3::UnitX()};
  const PlaneFrame light = light_at(2);
  const Vec3 a(0.0002, -1, 1.9995), b(0.0002, 1, 1.9995);
  double sum = 0;
  constexpr int parts = 20000;
  for (int i = 0; i < parts; ++i) {
    const Vec3 x = a + (i + 0.5) / parts * (b - a), w = x - at.position;
    const Vec3 q = at.position + 2 * w;  // the edge is halfway up: the image moves by −1, length 2
    sum += kernel(at, light, q) * 2 * (b - a).norm() / parts;
  }
  EXPECT_NEAR(boundary_motion(at, light, a, b), sum, 1e-3 * sum);
  EXPECT_NEAR(boundary_motion(at, light, a, {0.0002, 0, 1.9995}) * 2,
              boundary_motion(at, light, a, b), 1e-13 * sum);
}

}  // namespace
}  // namespace halfshade
