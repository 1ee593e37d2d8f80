#include "meshing/rays/visibility.h"

#include "meshing/core/error.h"
#include "tests/support/soups.h"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>
#include <thread>
#include <tuple>

namespace halfshade {
namespace {

using test::Random;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<Segment> random_segments(int count, Random& random, double low = 0, double high = 1) {
  std::vector<Segment> segments;
  for (int i = 0; i < count; ++i) {
    const Vec3 from = random.point(low, high);
    segments.push_back({from, random.point(low, high)});
  }
  return segments;
}

/// A unit square in z = height that looks up, as two triangles.
TriangleSoup square(double height, int plane = -1) {
  TriangleSoup soup;
  const Vec3 a(0, 0, height), b(1, 0, height), c(1, 1, height), d(0, 1, height);
  test::add_triangle(soup, a, b, c, 7, plane);
  test::add_triangle(soup, a, c, d, 7, plane);
  return soup;
}

std::vector<std::uint8_t> batch(const VisibilityIndex& index,
                                const std::vector<Segment>& segments) {
  std::vector<std::uint8_t> result(segments.size(), 9);
  index.blocked(segments, result);
  return result;
}

std::vector<std::uint8_t> one_by_one(const VisibilityIndex& index,
                                     const std::vector<Segment>& segments) {
  std::vector<std::uint8_t> result;
  for (const Segment& s : segments) result.push_back(index.blocked(s) ? 1 : 0);
  return result;
}

/// Compares the index of the soup moved by p ↦ scale·p + shift with brute force on the unmoved one.
/// Segments that pass a triangle's border or end on it within `margin` are skipped; returns how
/// many.
int expect_as_brute_force(const TriangleSoup& soup, const std::vector<Segment>& segments,
                          double scale, const Vec3& shift, double margin) {
  TriangleSoup moved = soup;
  for (Vec3& p : moved.points) p = scale * p + shift;
  const VisibilityIndex index(moved);
  int skipped = 0, hits = 0;
  for (const Segment& s : segments) {
    const double clear = test::clearance(s.from, s.to, soup);
    if (std::abs(clear) < margin) {
      ++skipped;
      continue;
    }
    hits += clear > 0 ? 1 : 0;
    EXPECT_EQ(index.blocked({scale * s.from + shift, scale * s.to + shift}), clear > 0)
        << "clearance " << clear << ", scale " << scale;
  }
  EXPECT_GT(hits, static_cast<int>(segments.size()) / 10);
  EXPECT_LT(hits, static_cast<int>(segments.size()) * 9 / 10);
  return skipped;
}

TEST(Visibility, AgreesWithExtendedPrecisionBruteForce) {
  Random random(1);
  const TriangleSoup soup = test::random_soup(300, 0.2, random);
  const auto segments = random_segments(4000, random);
  EXPECT_LT(expect_as_brute_force(soup, segments, 1, Vec3::Zero(), 1e-4), 40);
}

TEST(Visibility, DoesNotChangeWithScaleAndPlace) {
  Random random(2);
  const TriangleSoup soup = test::random_soup(300, 0.2, random);
  const auto segments = random_segments(1000, random);
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6})
    for (const double shift : {0.0, 1e6}) {
      const Vec3 place = scale * shift * Vec3(1, -0.7, 0.3);
      EXPECT_LT(expect_as_brute_force(soup, segments, scale, place, 1e-4), 10);
    }
}

TEST(Visibility, SegmentsFromFarAwayLoseNoPrecision) {
  Random random(3);
  const TriangleSoup soup = test::random_soup(300, 0.2, random);
  const VisibilityIndex index(soup);
  int hits = 0;
  for (const Segment& s : random_segments(1000, random)) {
    const Vec3 middle = (s.from + s.to) / 2, way = (s.to - s.from) * 1e7;
    const double clear = test::clearance(middle - way, middle + way, soup);
    if (clear < 0) continue;
    // Barycentric coordinates only: the distances from the ends are relative to the far ends.
    EXPECT_TRUE(index.blocked(Segment{middle - way, middle + way}) || clear < 1e-4);
    ++hits;
  }
  EXPECT_GT(hits, 300);
}

TEST(Visibility, NothingSlipsThroughEdgesAndVerticesOfAClosedMesh) {
  for (const double flatness : {1.0, 1e-2, 1e-4}) {  // flat ones are met at grazing angles
    TriangleSoup ball = test::sphere(24, 48);
    const Vec3 shape(1, 1, flatness);
    for (Vec3& p : ball.points) p = shape.cwiseProduct(p);
    const VisibilityIndex index(ball);
    Random random(4);
    std::vector<Segment> segments;
    const auto aim = [&](const Vec3& target) {
      const Vec3 inside = shape.cwiseProduct(random.point(-0.4, 0.4));
      segments.push_back({inside, inside + (target - inside) * random(1.2, 5)});
      segments.push_back({inside + (target - inside) * 3, inside});
    };
    for (const auto& t : ball.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 a = ball.points[static_cast<std::size_t>(t[k])];
        const Vec3 b = ball.points[static_cast<std::size_t>(t[(k + 1) % 3])];
        aim(a);
        aim((a + b) / 2);
        aim(a + random(0, 1) * (b - a));
      }
    EXPECT_THAT(batch(index, segments), testing::Each(1));
    EXPECT_THAT(one_by_one(index, segments), testing::Each(1));
    for (const Segment& s : segments)
      EXPECT_TRUE(index.first_hit(s.from, s.to - s.from).has_value());
  }
}

TEST(Visibility, TrianglesInTheEndPlanesDoNotBlock) {
  TriangleSoup soup = square(0.5, 3);
  const Vec3 below(0.4, 0.3, 0), above(0.4, 0.3, 1);
  const VisibilityIndex index(soup);
  EXPECT_TRUE(index.blocked(Segment{below, above}));
  EXPECT_TRUE(index.blocked(Segment{below, above, 2, 4}));
  EXPECT_FALSE(index.blocked(Segment{below, above, 3, 4}));
  EXPECT_FALSE(index.blocked(Segment{below, above, 4, 3}));
  EXPECT_THAT(batch(index, {{below, above}, {below, above, 3, -1}, {below, above, -1, 3}}),
              testing::ElementsAre(1, 0, 0));
  const VisibilityIndex without_planes(square(0.5, -1));
  EXPECT_TRUE(without_planes.blocked(Segment{below, above, -1, -1}));
}

TEST(Visibility, EndPointsMayLieOnTrianglesAtAnyAngle) {
  const TriangleSoup soup = square(0);
  const VisibilityIndex index(soup);
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 on(random(0, 1), random(0, 1), 0);
    const double rise = std::pow(10, random(-9, 0));
    const Vec3 off(random(0, 1), random(0, 1), (i & 1) ? rise : -rise);
    EXPECT_FALSE(index.blocked(Segment{on, off})) << rise;
    EXPECT_FALSE(index.blocked(Segment{off, on})) << rise;
    EXPECT_FALSE(index.first_hit(on, off - on).has_value()) << rise;
    EXPECT_TRUE(index.first_hit(off, on - off).has_value()) << rise;
  }
}

TEST(Visibility, SegmentsAcrossAPlaneAreDecidedCloseToIt) {
  const VisibilityIndex index(square(0));
  for (const double gap : {1e-2, 1e-5, 1e-8}) {
    const Vec3 above(0.3, 0.6, gap), far_below(0.5, 0.4, -1), far_above(0.5, 0.4, 1);
    EXPECT_TRUE(index.blocked(Segment{above, far_below})) << gap;
    EXPECT_TRUE(index.blocked(Segment{far_below, above})) << gap;
    EXPECT_FALSE(index.blocked(Segment{above, far_above})) << gap;
    EXPECT_FALSE(index.blocked(Segment{far_above, above})) << gap;
  }
}

TEST(Visibility, BordersAreDecidedBeyondSinglePrecision) {
  const VisibilityIndex index(square(0));
  for (const double past : {1e-6, 1e-8, 1e-10})
    for (const double side : {0.0, 1.0}) {
      const double in = side == 0 ? past : 1 - past, out = side == 0 ? -past : 1 + past;
      EXPECT_TRUE(index.blocked(Segment{{in, 0.5, -1}, {in, 0.5, 1}}));
      EXPECT_TRUE(index.blocked(Segment{{0.3, in, -1}, {0.3, in, 1}}));
      EXPECT_FALSE(index.blocked(Segment{{out, 0.5, -1}, {out, 0.5, 1}}));
      EXPECT_FALSE(index.blocked(Segment{{0.3, out, -1}, {0.3, out, 1}}));
    }
}

TEST(Visibility, SegmentsInATrianglesPlaneAreNotBlockedByIt) {
  TriangleSoup soup = square(0.25);
  const TriangleSoup twin = square(0.25);
  for (std::size_t t = 0; t < 2; ++t) {
    const auto c = test::corners(twin, t);
    test::add_triangle(soup, c[0], c[2], c[1]);  // coplanar overlap, looking the other way
  }
  const VisibilityIndex index(soup);
  EXPECT_FALSE(index.blocked(Segment{{-1, 0.3, 0.25}, {2, 0.6, 0.25}}));
  EXPECT_TRUE(index.blocked(Segment{{-1, 0.3, 0}, {2, 0.6, 0.5}}));
}

TEST(Visibility, BatchesEqualSingleQueries) {
  Random random(6);
  const TriangleSoup soup = test::random_soup(500, 0.15, random);
  const VisibilityIndex index(soup);
  for (const int count : {0, 1, 15, 16, 17, 1000, 4097, 20011}) {
    const auto segments = random_segments(count, random);
    const auto result = batch(index, segments);
    const auto single = one_by_one(index, segments);
    EXPECT_EQ(result, single);
    EXPECT_TRUE(count < 1000 || std::count(result.begin(), result.end(), 1) > count / 5);
  }
}

TEST(Visibility, FirstHitIsTheNearestOfBruteForce) {
  Random random(7);
  const TriangleSoup soup = test::random_soup(300, 0.2, random);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    TriangleSoup moved = soup;
    const Vec3 shift = scale * Vec3(100, -200, 300);
    for (Vec3& p : moved.points) p = scale * p + shift;
    const VisibilityIndex index(moved);
    int hits = 0;
    for (const Segment& s : random_segments(1000, random)) {
      const Vec3 direction = s.to - s.from, end = s.from + 10 * direction;
      std::size_t nearest = soup.triangles.size();
      double distance = infinite;
      bool clear = true;
      for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const auto c = test::corners(soup, t);
        const double margin = test::clearance(s.from, end, c);
        clear = clear && std::abs(margin) > 1e-5;
        if (margin < 0) continue;
        const Vec3 n = (c[1] - c[0]).cross(c[2] - c[0]);
        const double d = n.dot(c[0] - s.from) / n.dot(direction) * direction.norm();
        if (d < distance) nearest = t;
        distance = std::min(d, distance);
      }
      if (!clear) continue;
      const auto hit = index.first_hit(scale * s.from + shift, direction * random(0.01, 100));
      ASSERT_EQ(hit.has_value(), nearest < soup.triangles.size());
      if (!hit) continue;
      ++hits;
      EXPECT_EQ(hit->triangle, static_cast<int>(nearest));
      EXPECT_EQ(hit->owner, soup.owner[nearest]);
      EXPECT_NEAR(hit->distance / scale, distance, 3e-6);
      const auto c = test::corners(soup, nearest);
      Vec3 point = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) point += hit->weights[k] * c[k];
      EXPECT_LT((point - (s.from + distance * direction.normalized())).norm(), 1e-5);
      EXPECT_NEAR(hit->weights[0] + hit->weights[1] + hit->weights[2], 1, 1e-12);
    }
    EXPECT_GT(hits, 400);
  }
}

TEST(Visibility, FirstHitFromFarAwayIsAccurate) {
  const VisibilityIndex index(square(0.5));
  const Vec3 origin(1e6, 2e6, 3e6), target(0.25, 0.5, 0.5);
  const auto hit = index.first_hit(origin, target - origin);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, (target - origin).norm(), 1e-8);
  // On a + w1 (b − a) + w2 (c − a) of the second triangle, (0,0) (1,1) (0,1): w1 = x, w2 = y − x.
  EXPECT_EQ(hit->triangle, 1);
  EXPECT_NEAR(hit->weights[0], 0.5, 1e-5);
  EXPECT_NEAR(hit->weights[1], 0.25, 1e-5);
  EXPECT_NEAR(hit->weights[2], 0.25, 1e-5);
}

TEST(Visibility, BacksLetFrontOnlyRaysPass) {
  TriangleSoup soup = square(1);  // looks up
  const TriangleSoup upper = square(2);
  for (std::size_t t = 0; t < 2; ++t) {
    const auto c = test::corners(upper, t);
    test::add_triangle(soup, c[0], c[2], c[1], 8);  // looks down
  }
  const VisibilityIndex index(soup);
  const Vec3 below(0.3, 0.4, 0), above(0.3, 0.4, 3), up(0, 0, 2), down(0, 0, -2);
  EXPECT_EQ(index.first_hit(below, up)->owner, 7);
  EXPECT_EQ(index.first_hit(below, up, Sides::front_only)->owner, 8);
  EXPECT_NEAR(index.first_hit(below, up, Sides::front_only)->distance, 2, 1e-6);
  EXPECT_EQ(index.first_hit(above, down)->owner, 8);
  EXPECT_EQ(index.first_hit(above, down, Sides::front_only)->owner, 7);
  EXPECT_FALSE(index.first_hit({0.3, 0.4, 1.5}, {0, 0, 0}, Sides::front_only));
}

TEST(Visibility, OfTwoBackToBackARayFindsTheOneThatFacesIt) {
  TriangleSoup soup = square(0.5);
  const Vec3 a(0, 0, 0.5), b(1, 0, 0.5), c(1, 1, 0.5), d(0, 1, 0.5);
  test::add_triangle(soup, d, c, b, 8);
  test::add_triangle(soup, d, b, a, 8);
  test::add_triangle(soup, Vec3(0, 0, 0.7), Vec3(0, 1, 0.7), Vec3(1, 0, 0.7), 9);  // looks down
  const VisibilityIndex index(soup);
  const Vec3 direction = Vec3(0.1, 0.2, 1).normalized();
  const HalfLine up{Vec3(0.2, 0.3, 0), direction}, down{Vec3(0.2, 0.3, 1), -direction};
  for (const auto& [ray, behind, facing] : {std::tuple(up, 7, 8), std::tuple(down, 8, 7)}) {
    const auto found = index.facing_hit(ray, {behind, 0, 0.5 / direction.z()});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->owner, facing);
  }
  // One that stands alone.
  EXPECT_FALSE(index.facing_hit(down, {9, 4, 0.3 / direction.z()}));
}

TEST(Visibility, AnEmptySoupBlocksNothing) {
  const VisibilityIndex index(TriangleSoup{});
  EXPECT_FALSE(index.blocked(Segment{{0, 0, 0}, {1, 1, 1}}));
  EXPECT_THAT(batch(index, {{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 0}, {1, 2, 1}}}), testing::Each(0));
  EXPECT_FALSE(index.first_hit({0, 0, 0}, {1, 0, 0}));
  EXPECT_TRUE(index.soup().triangles.empty());
}

TEST(Visibility, TrianglesWithoutAreaBlockNothing) {
  TriangleSoup soup;
  test::add_triangle(soup, {0, 0, 0}, {0, 0, 0}, {0, 0, 0});
  test::add_triangle(soup, {0.5, 0, 0.5}, {0.5, 1, 0.5}, {0.5, 2, 0.5});
  test::add_triangle(soup, {0.5, 0, 0.5}, {0.5, 1, 0.5}, {0.5, 0, 0.5});
  const VisibilityIndex index(soup);
  EXPECT_FALSE(index.blocked(Segment{{0.5, 0.5, 0}, {0.5, 0.5, 1}}));
  EXPECT_FALSE(index.first_hit({0.5, 0.5, 0}, {0, 0, 1}));
  TriangleSoup point;
  test::add_triangle(point, {3, 3, 3}, {3, 3, 3}, {3, 3, 3});
  EXPECT_FALSE(VisibilityIndex(point).blocked(Segment{{2, 2, 2}, {4, 4, 4}}));
}

TEST(Visibility, BrokenSegmentsAreNotBlocked) {
  const VisibilityIndex index(square(0.5));
  const Vec3 below(0.4, 0.3, 0), above(0.4, 0.3, 1);
  std::vector<Segment> segments = {{below, above}, {below, below}};
  for (const double bad : {not_a_number, infinite, -infinite, 1e308})
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 broken = above;
      broken[axis] = bad;
      if (bad == 1e308 && axis == 2) continue;  // straight up: an honest segment
      segments.push_back({below, broken});
      segments.push_back({broken, below});
      EXPECT_FALSE(index.first_hit(broken, {0, 0, 1})) << bad << axis;
    }
  const auto result = batch(index, segments);
  EXPECT_EQ(result.front(), 1);
  EXPECT_EQ(result, one_by_one(index, segments));
  EXPECT_EQ(std::count(result.begin(), result.end(), 1), 1);
  EXPECT_FALSE(index.first_hit(below, {0, 0, 0}));
  EXPECT_FALSE(index.first_hit(below, {0, 0, not_a_number}));
}

TEST(Visibility, ConcurrentQueriesEqualSerialOnes) {
  Random random(8);
  const VisibilityIndex index(test::random_soup(2000, 0.1, random));
  const auto segments = random_segments(20000, random);
  const auto serial = one_by_one(index, segments);
  const auto whole = batch(index, segments);
  std::vector<std::vector<std::uint8_t>> single(4), batches(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i)
    threads.emplace_back([&, i] {
      single[i] = one_by_one(index, segments);
      batches[i] = batch(index, segments);
    });
  for (std::thread& t : threads) t.join();
  EXPECT_THAT(single, testing::Each(serial));
  EXPECT_THAT(batches, testing::Each(whole));
}

TEST(Visibility, SurvivesBeingMoved) {
  VisibilityIndex first(square(0.5));
  VisibilityIndex second = std::move(first);
  EXPECT_TRUE(second.blocked(Segment{{0.4, 0.3, 0}, {0.4, 0.3, 1}}));
  second = VisibilityIndex(square(2));
  EXPECT_FALSE(second.blocked(Segment{{0.4, 0.3, 0}, {0.4, 0.3, 1}}));
}

TEST(Visibility, RefusesInconsistentSoups) {
  const auto expect_refused = [](const TriangleSoup& soup, const std::string& words) {
    try {
      const VisibilityIndex index(soup);
      ADD_FAILURE() << "accepted: " << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::contract);
      EXPECT_THAT(error.what(), testing::HasSubstr(words));
    }
  };
  TriangleSoup soup = square(0);
  soup.plane.pop_back();
  expect_refused(soup, "2 triangles have 2 owners and 1 planes");
  soup = square(0);
  soup.triangles[1][2] = 6;
  expect_refused(soup, "triangle 1 has corner 6 of 6");
  soup = square(0);
  soup.points[3].y() = not_a_number;
  expect_refused(soup, "point 3 is not finite");
  soup = square(1e200);
  soup.points[0].x() = -1e200;
  expect_refused(soup, "out of range");
  std::vector<std::uint8_t> room(2);
  EXPECT_THROW(VisibilityIndex(square(0)).blocked(std::vector<Segment>(3), room), Error);
}

}  // namespace
}  // namespace halfshade
