#include "meshing/geometry/exact_signs.h"

#include "tests/support/surfaces.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace halfshade {
namespace {

int turn(const Vec3& eye, const SeenPoint& a, const SeenPoint& b, const SeenPoint& c) {
  const int sign = clear_turn(a, b, c);
  EXPECT_TRUE(sign == 0 || sign == turn_exactly(eye, a, b, c));
  return turn_exactly(eye, a, b, c);
}

using test::Random;

SeenPoint seen(const Vec3& eye, const Vec3& position, int rank) {
  return {position, position - eye, rank};
}

TEST(ExactSigns, CounterClockwiseIsAsSeenFromTheEye) {
  const Vec3 eye(0, 0, 0);
  // Looking along +z with x to the right, y points down.
  const SeenPoint a = seen(eye, {0, 0, 1}, 0), b = seen(eye, {1, 0, 1}, 1);
  EXPECT_EQ(turn(eye, a, b, seen(eye, {0, -1, 1}, 2)), 1);
  EXPECT_EQ(turn(eye, a, b, seen(eye, {0, 1, 1}, 2)), -1);
}

TEST(ExactSigns, AHairOffThePlaneIsDecidedExactly) {
  const Vec3 eye(0.1, 0.1, 0.1);
  const SeenPoint a = seen(eye, {1.1, 0.1, 0.1}, 0), b = seen(eye, {0.1, 1.1, 0.1}, 1);
  for (int k = 1; k < 40; ++k) {
    double up = 0.1, down = 0.1;
    for (int i = 0; i < k; ++i) {
      up = std::nextafter(up, 1.);
      down = std::nextafter(down, 0.);
    }
    const int above = turn(eye, a, b, seen(eye, {0.7, 0.7, up}, 2));
    const int below = turn(eye, a, b, seen(eye, {0.7, 0.7, down}, 2));
    EXPECT_EQ(above, -1) << k;
    EXPECT_EQ(below, 1) << k;
  }
}

/// Points on a tiny grid: most triples lie in a plane with the eye, many are aligned with it, and
/// some coincide with it.
std::vector<SeenPoint> degenerate_points(Random& random, const Vec3& eye, int count) {
  std::vector<SeenPoint> points;
  while (static_cast<int>(points.size()) < count) {
    const Vec3 p(random.below(3), random.below(3), random.below(3));
    const auto same = [&](const SeenPoint& other) { return other.position == p; };
    if (std::none_of(points.begin(), points.end(), same))
      points.push_back(seen(eye, p, static_cast<int>(points.size())));
  }
  return points;
}

TEST(ExactSigns, AnswersAreAlternating) {
  Random random(1);
  for (int round = 0; round < 500; ++round) {
    const Vec3 eye(random.below(3), random.below(3), random.below(3));
    const auto p = degenerate_points(random, eye, 3);
    const int sign = turn(eye, p[0], p[1], p[2]);
    EXPECT_EQ(std::abs(sign), 1);
    EXPECT_EQ(turn(eye, p[1], p[2], p[0]), sign);
    EXPECT_EQ(turn(eye, p[2], p[0], p[1]), sign);
    EXPECT_EQ(turn(eye, p[1], p[0], p[2]), -sign);
    EXPECT_EQ(turn(eye, p[0], p[2], p[1]), -sign);
    EXPECT_EQ(turn(eye, p[2], p[1], p[0]), -sign);
  }
}

TEST(ExactSigns, TiesAreBrokenAsSomeSceneInGeneralPositionWould) {
  // Signs of determinants obey Grassmann and Plücker's relation
  // [abc][ade] − [abd][ace] + [abe][acd] = 0: the three terms cannot have one sign.
  Random random(2);
  for (int round = 0; round < 3000; ++round) {
    const Vec3 eye(random.below(3), random.below(3), random.below(3));
    const auto p = degenerate_points(random, eye, 5);
    const auto sign = [&](std::size_t i, std::size_t j, std::size_t k) {
      return turn(eye, p[i], p[j], p[k]);
    };
    const int first = sign(0, 1, 2) * sign(0, 3, 4), second = -sign(0, 1, 3) * sign(0, 2, 4);
    const int third = sign(0, 1, 4) * sign(0, 2, 3);
    EXPECT_FALSE(first == second && second == third) << "round " << round;
  }
}

}  // namespace
}  // namespace halfshade
