#include "meshing/geometry/shaft.h"

#include "tests/support/soups.h"

#include <gmock/gmock.h>
#include <set>
#include <thread>

namespace halfshade {
namespace {

using Polygon = std::vector<Vec3>;
using test::Random;

/// A square of the given half width about a centre, turned to face `normal`.
Polygon square(const Vec3& centre, const Vec3& normal, double half) {
  const Vec3 other = std::abs(normal.x()) < 0.9 * normal.norm() ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 u = normal.cross(other).normalized() * half, v = normal.normalized().cross(u);
  return {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
}

Polygon random_polygon(Random& random) {
  const double half = random(0.02, 0.2);
  const Vec3 centre = random.point(0, 1);
  if (random(0, 1) < 0.2) return {centre};
  Polygon p = square(centre, random.point(-1, 1), half);
  if (random(0, 1) < 0.5) p[2] = p[0] + 0.3 * (p[2] - p[0]);  // no longer convex
  if (random(0, 1) < 0.3) p.pop_back();
  return p;
}

/// A point of the polygon's convex hull.
Vec3 random_point(const Polygon& polygon, Random& random) {
  Vec3 sum = Vec3::Zero();
  double weights = 0;
  for (const Vec3& p : polygon) {
    const double w = std::pow(random(0, 1), 3);  // often near corners and edges
    sum += w * p;
    weights += w;
  }
  return sum / weights;
}

/// Unit squares z = const in a 10 × 10 × 10 lattice of cells, a quarter wide, each one owner.
TriangleSoup lattice() {
  TriangleSoup soup;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 centre = Vec3(i % 10, i / 10 % 10, i / 100) + Vec3::Constant(0.5);
    const Polygon p = square(centre, Vec3::UnitZ(), 0.25);
    test::add_triangle(soup, p[0], p[1], p[2], i);
    test::add_triangle(soup, p[0], p[2], p[3], i);
  }
  return soup;
}

std::vector<int> candidates(const TriangleSoup& soup, const Polygon& a, const Polygon& b) {
  return VisibilityIndex(soup).candidates(a, b);
}

bool between(const std::array<Vec3, 3>& triangle, const Polygon& a, const Polygon& b) {
  TriangleSoup soup;
  test::add_triangle(soup, triangle[0], triangle[1], triangle[2]);
  return !candidates(soup, a, b).empty();
}

const Polygon floor_square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const Polygon ceiling_square = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
const Polygon wall_square = {
    {1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}};  // meets the floor in an edge

TEST(Shaft, HoldsEveryTriangleThatBlocksASegment) {
  Random random(1);
  const TriangleSoup soup = test::random_soup(400, 0.2, random);
  const VisibilityIndex index(soup);
  int blockers = 0;
  for (int i = 0; i < 200; ++i) {
    const Polygon a = random_polygon(random), b = random_polygon(random);
    const auto found = index.candidates(a, b);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    const std::set<int> owners(found.begin(), found.end());
    EXPECT_EQ(owners.size(), found.size());
    for (int k = 0; k < 40; ++k) {
      const Vec3 from = random_point(a, random), to = random_point(b, random);
      for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        if (test::clearance(from, to, test::corners(soup, t)) > 1e-9) {
          EXPECT_TRUE(owners.contains(soup.owner[t])) << "shaft " << i << ", triangle " << t;
          ++blockers;
        }
    }
  }
  EXPECT_GT(blockers, 10000);
}

TEST(Shaft, LeavesOutWhatTheHullDoesNotReach) {
  // Between two small squares at opposite corners of the lattice: the tube about its diagonal,
  // 0.3 wide, meets the ten plates on the diagonal and none of their neighbours, 0.5 away.
  const Vec3 diagonal = Vec3::Ones();
  const auto found = candidates(lattice(), square(-0.1 * diagonal, diagonal, 0.15),
                                square(10.1 * diagonal, diagonal, 0.15));
  std::vector<int> expected;
  for (int i = 0; i < 10; ++i) expected.push_back(111 * i);
  EXPECT_EQ(found, expected);
}

/// Whether the convex hull of the corners overlaps the triangle by more than `depth`: no axis
/// separates them (all axes that can are tried: Gottschalk 1996).
bool overlaps(const std::vector<Vec3>& corners, const std::array<Vec3, 3>& triangle, double depth) {
  std::vector<Vec3> axes = {(triangle[1] - triangle[0]).cross(triangle[2] - triangle[0])};
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 edge = corners[i] - corners[j];
      for (std::size_t k = 0; k < 3; ++k)
        axes.push_back(edge.cross(triangle[(k + 1) % 3] - triangle[k]));
      for (std::size_t k = 0; k < j; ++k) axes.push_back(edge.cross(corners[k] - corners[j]));
    }
  const auto extent = [](const auto& points, const Vec3& axis) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Vec3& p : points) {
      low = std::min(low, axis.dot(p));
      high = std::max(high, axis.dot(p));
    }
    return std::pair(low, high);
  };
  for (const Vec3& axis : axes) {
    if (axis.norm() < 1e-9) continue;
    const auto hull = extent(corners, axis), other = extent(triangle, axis);
    if (std::min(hull.second - other.first, other.second - hull.first) <= depth * axis.norm())
      return false;
  }
  return true;
}

TEST(Shaft, IsHardlyLargerThanTheHull) {
  Random random(2);
  const TriangleSoup soup = lattice();
  const VisibilityIndex index(soup);
  std::size_t found = 0, reached = 0;
  for (int i = 0; i < 20; ++i) {
    Polygon a = random_polygon(random), b = random_polygon(random);
    for (Polygon* polygon : {&a, &b})
      for (Vec3& p : *polygon) p *= 10;
    const auto owners = index.candidates(a, b);
    found += owners.size();
    Polygon both = a;
    both.insert(both.end(), b.begin(), b.end());
    std::set<int> expected;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
      if (overlaps(both, test::corners(soup, t), 1e-9)) expected.insert(soup.owner[t]);
    reached += expected.size();
    // Plates that reach in but have both polygons on one side of them are left out, rightly.
    for (const int plate : expected) {
      const double z = soup.points[static_cast<std::size_t>(6 * plate)].z();
      const auto below = [&](const Vec3& p) { return p.z() < z; };
      const bool divides = std::any_of(both.begin(), both.end(), below) &&
                           !std::all_of(both.begin(), both.end(), below);
      EXPECT_TRUE(!divides || std::binary_search(owners.begin(), owners.end(), plate));
    }
  }
  EXPECT_GT(reached, 300u);
  EXPECT_LT(static_cast<double>(found), 1.1 * static_cast<double>(reached));
}

TEST(Shaft, LeavesOutTrianglesThatOnlyTouch) {
  const auto scaled = [](const std::array<Vec3, 3>& t, double inwards) {
    const Vec3 middle(0.5, 0.5, 0.5);
    std::array<Vec3, 3> out;
    for (std::size_t k = 0; k < 3; ++k) out[k] = middle + (1 - inwards) * (t[k] - middle);
    return out;
  };
  // In the six faces of the cube between floor and ceiling.
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.0, 1.0}) {
      std::array<Vec3, 3> face = {Vec3(0.2, 0.2, 0.2), Vec3(0.9, 0.3, 0.3), Vec3(0.4, 0.8, 0.9)};
      for (Vec3& p : face) p[axis] = side;
      EXPECT_FALSE(between(face, floor_square, ceiling_square)) << axis << side;
      // Moved in by a little: between the two, unless it stands on edge to them.
      EXPECT_TRUE(between(scaled(face, 1e-9), floor_square, ceiling_square)) << axis << side;
      EXPECT_FALSE(between(scaled(face, -1e-9), floor_square, ceiling_square)) << axis << side;
    }
  // Leaning on an edge, on a corner, from outside.
  EXPECT_FALSE(
      between({Vec3(1, 0, 0), Vec3(1, 0, 1), Vec3(2, -1, 0.5)}, floor_square, ceiling_square));
  EXPECT_FALSE(
      between({Vec3(1, 1, 1), Vec3(2, 1, 1), Vec3(1, 2, 2)}, floor_square, ceiling_square));
  EXPECT_FALSE(
      between({Vec3(1, 1, 0.5), Vec3(2, 1, 0.5), Vec3(1, 2, 0.5)}, floor_square, ceiling_square));
}

TEST(Shaft, LeavesOutTrianglesWithBothPolygonsOnOneSide) {
  // A ramp under the shaft's edge: reaches into the hull's box and is tangent to no side of it.
  const Polygon low = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const Polygon high = {{0.2, 0.2, 1}, {0.2, 0.8, 1}, {0.8, 0.8, 1}, {0.8, 0.2, 1}};
  // The plane through the wall and the floor: 45 degrees, everything else above it.
  EXPECT_FALSE(between({Vec3(1, -1, 0), Vec3(1, 2, 0), Vec3(0.95, 0.5, 1)}, low, high));
  // Planes that cut off nothing of either polygon, their triangles partly within the hull's box.
  EXPECT_FALSE(between({Vec3(2, 0, -0.5), Vec3(2, 1, -0.5), Vec3(0.5, 0.5, -1e-13)}, low, high));
  EXPECT_TRUE(between({Vec3(2, 0, 0.5), Vec3(2, 1, 0.5), Vec3(0.5, 0.5, 0.5)}, low, high));
}

TEST(Shaft, OfPolygonsThatShareAnEdgeIsTheWedge) {
  // Floor and wall: the hull is the prism z ≤ x over the floor.
  EXPECT_TRUE(between({Vec3(0.5, 0.2, 0), Vec3(0.5, 0.8, 0), Vec3(0.5, 0.5, 0.4)}, floor_square,
                      wall_square));
  EXPECT_FALSE(between({Vec3(0.2, 0.2, 0.5), Vec3(0.2, 0.8, 0.5), Vec3(0.4, 0.5, 0.6)},
                       floor_square, wall_square));
  EXPECT_FALSE(between({Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 0.5, 1)}, floor_square, wall_square));
  EXPECT_FALSE(
      between({floor_square[0], floor_square[1], floor_square[2]}, floor_square, wall_square));
  EXPECT_FALSE(
      between({wall_square[0], wall_square[1], wall_square[2]}, floor_square, wall_square));
}

TEST(Shaft, OfAPolygonBesideTheOthersPlaneKeepsThatPlane) {
  // A wall that stands on the floor's plane beyond its edge: things in and below the plane are out.
  Polygon wall = wall_square;
  for (Vec3& p : wall) p.x() = 1.5;
  const Shaft shaft = make_shaft(floor_square, wall, 1e-12);
  const auto down = std::count_if(shaft.sides.begin(), shaft.sides.end(), [](const auto& side) {
    return (side.normal + Vec3::UnitZ()).norm() < 1e-12 && std::abs(side.limit) < 1e-12;
  });
  EXPECT_EQ(down, 1);
  EXPECT_EQ(shaft.sides.size(), 5u);  // below, above (tilted), behind the wall, left, right
  EXPECT_FALSE(
      between({Vec3(1.2, 0.2, 0), Vec3(1.4, 0.8, 0), Vec3(1.3, 0.5, 0)}, floor_square, wall));
  EXPECT_TRUE(between({Vec3(1.2, 0, 0), Vec3(1.2, 1, 0), Vec3(1.2, 0.5, 0.1)}, floor_square, wall));
}

TEST(Shaft, SidesHoldBothPolygonsAndTouchThem) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Polygon a = random_polygon(random), b = random_polygon(random);
    const Shaft shaft = make_shaft(a, b, 1e-12);
    EXPECT_LE(shaft.sides.size(), 64u);
    EXPECT_GE(shaft.sides.size(), a.size() + b.size() > 2 ? 2u : 4u);
    for (const Shaft::Side& side : shaft.sides) {
      EXPECT_NEAR(side.normal.norm(), 1, 1e-14);
      int on = 0;
      for (const Polygon* polygon : {&a, &b})
        for (const Vec3& p : *polygon) {
          EXPECT_LE(side.normal.dot(p), side.limit);
          on += side.normal.dot(p) > side.limit - 1e-9 ? 1 : 0;
        }
      EXPECT_GE(on, std::min<int>(3, static_cast<int>(a.size() + b.size())));
    }
  }
}

TEST(Shaft, OfAConvexPairHasTheFacetsOfItsHull) {
  EXPECT_EQ(make_shaft(floor_square, ceiling_square, 1e-12).sides.size(), 6u);
  EXPECT_EQ(make_shaft(floor_square, wall_square, 1e-12).sides.size(), 5u);
  const Polygon apex = {{0.5, 0.5, 2}};
  EXPECT_EQ(make_shaft(floor_square, apex, 1e-12).sides.size(), 5u);  // a pyramid
  EXPECT_EQ(make_shaft(apex, floor_square, 1e-12).sides.size(), 5u);
  Polygon turned;  // the antiprism over a square: two squares and eight triangles
  for (int k = 0; k < 4; ++k) {
    const double angle = 0.7853981633974483 * (2 * k);
    turned.emplace_back(0.5 + 0.7 * std::cos(angle), 0.5 + 0.7 * std::sin(angle), 1);
  }
  EXPECT_EQ(make_shaft(floor_square, turned, 1e-12).sides.size(), 10u);
}

TEST(Shaft, OfPointsIsTheSegment) {
  const Polygon a = {{0.1, 0.2, 0.3}}, b = {{0.9, 0.7, 0.8}};
  const Vec3 middle = (a[0] + b[0]) / 2, way = b[0] - a[0];
  const auto hit = square(middle, way, 0.1), beside = square(middle + Vec3(0, 0.3, -0.3), way, 0.1);
  EXPECT_TRUE(between({hit[0], hit[1], hit[2] + 0.1 * (hit[2] - hit[0])}, a, b));
  EXPECT_FALSE(between({beside[0], beside[1], beside[2]}, a, b));
  const auto beyond = square(b[0] + 0.01 * way, way, 0.1);
  EXPECT_FALSE(between({beyond[0], beyond[1], beyond[2]}, a, b));
  EXPECT_FALSE(between({hit[0], hit[1], hit[2]}, a, a));
}

TEST(Shaft, OfCoplanarPolygonsHoldsOnlyWhatCrossesTheirPlane) {
  Polygon next = floor_square;
  for (Vec3& p : next) p.x() += 2;
  EXPECT_FALSE(between({Vec3(1.2, 0, 0), Vec3(1.8, 0, 0), Vec3(1.5, 1, 0)}, floor_square, next));
  EXPECT_FALSE(between({Vec3(1.5, 0, 0), Vec3(1.5, 1, 0), Vec3(1.5, 0.5, 1)}, floor_square, next));
  EXPECT_TRUE(between({Vec3(1.5, 0, -1), Vec3(1.5, 1, -1), Vec3(1.5, 0.5, 1)}, floor_square, next));
}

TEST(Shaft, WithManyVerticesStaysConservative) {
  Polygon disc, star;
  for (int k = 0; k < 400; ++k) {
    const double angle = 2 * 3.14159265358979323846 * k / 400, r = k % 2 == 0 ? 1 : 0.4;
    disc.emplace_back(std::cos(angle), std::sin(angle), 0);
    star.emplace_back(r * std::cos(angle), r * std::sin(angle), 2);
  }
  const Shaft shaft = make_shaft(disc, star, 1e-12);
  EXPECT_LE(shaft.sides.size(), 64u);
  EXPECT_GE(shaft.sides.size(), 16u);
  // Inside and outside the cylinder that is the hull.
  EXPECT_TRUE(between({Vec3(0.99, 0, 1), Vec3(1.5, 0.1, 1), Vec3(1.5, -0.1, 1)}, disc, star));
  EXPECT_FALSE(between({Vec3(1.1, 0, 1), Vec3(1.5, 0.1, 1), Vec3(1.5, -0.1, 1)}, disc, star));
}

TEST(Shaft, DoesNotChangeWithScaleAndPlace) {
  Random random(4);
  const TriangleSoup soup = test::random_soup(2000, 0.1, random);
  const Polygon a = square({0.1, 0.2, 0.1}, {1, 2, 3}, 0.1);
  const Polygon b = square({0.9, 0.7, 0.8}, {-1, 0.3, -1}, 0.15);
  const auto expected = candidates(soup, a, b);
  EXPECT_GT(expected.size(), 20u);
  EXPECT_EQ(candidates(soup, b, a), expected);
  for (const double scale : {1e-6, 1.0, 1e6})
    for (const double shift : {0.0, 1e6}) {
      const auto move = [&](std::vector<Vec3> points) {
        for (Vec3& p : points) p = scale * (p + shift * Vec3(1, -0.7, 0.3));
        return points;
      };
      TriangleSoup moved = soup;
      moved.points = move(soup.points);
      EXPECT_EQ(candidates(moved, move(a), move(b)), expected) << scale << ' ' << shift;
    }
}

TEST(Shaft, TreeFindsWhatATestOfEveryTriangleFinds) {
  Random random(5);
  const TriangleSoup soup = test::random_soup(3000, 0.05, random);
  const VisibilityIndex index(soup);
  for (int i = 0; i < 50; ++i) {
    const Polygon a = random_polygon(random), b = random_polygon(random);
    const Shaft shaft = make_shaft(a, b, 1e-12);
    std::vector<int> expected;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
      if (!is_harmless(shaft, test::corners(soup, t), all_sides(shaft)))
        expected.push_back(soup.owner[t]);
    EXPECT_EQ(index.candidates(a, b), expected);
  }
}

TEST(Shaft, ConcurrentQueriesEqualSerialOnes) {
  Random random(6);
  const TriangleSoup soup = test::random_soup(2000, 0.1, random);
  std::vector<Polygon> polygons;
  for (int i = 0; i < 101; ++i) polygons.push_back(random_polygon(random));
  const auto query_all = [&](const VisibilityIndex& index) {
    std::vector<std::vector<int>> out;
    for (std::size_t i = 0; i + 1 < polygons.size(); ++i)
      out.push_back(index.candidates(polygons[i], polygons[i + 1]));
    return out;
  };
  const auto serial = query_all(VisibilityIndex(soup));
  const VisibilityIndex shared(soup);  // its tree is not made yet
  std::vector<std::vector<std::vector<int>>> results(4);
  std::vector<std::thread> threads;
  for (auto& result : results) threads.emplace_back([&] { result = query_all(shared); });
  for (std::thread& t : threads) t.join();
  EXPECT_THAT(results, testing::Each(serial));
}

TEST(Shaft, OddInputIsAnswered) {
  const TriangleSoup soup = lattice();
  EXPECT_TRUE(candidates(TriangleSoup{}, floor_square, ceiling_square).empty());
  EXPECT_THROW(candidates(soup, {}, floor_square), std::runtime_error);
  EXPECT_TRUE(candidates(soup, {{5, 5, 5}}, {{5, 5, 5}}).empty());
  const Polygon line = {{0, 0, 5}, {5, 0, 5}, {10, 0, 5}}, point = {{5, 10, 5.01}};
  EXPECT_FALSE(candidates(soup, line, point).size() > 200);
  const Polygon repeated = {{1, 1, -1}, {1, 1, -1}, {2, 1, -1}, {2, 1, -1}, {1, 2, -1}};
  const Polygon plain = {{1, 1, -1}, {2, 1, -1}, {1, 2, -1}}, target = {{1.2, 1.3, 11}};
  EXPECT_EQ(candidates(soup, repeated, target), candidates(soup, plain, target));
  TriangleSoup flat;
  test::add_triangle(flat, {0.5, 0.5, 0.5}, {0.6, 0.5, 0.5}, {0.7, 0.5, 0.5});  // no area
  EXPECT_TRUE(candidates(flat, floor_square, ceiling_square).empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(candidates(soup, {{nan, 0, 0}, {1, nan, 0}, {0, 1, 0}}, ceiling_square));
}

}  // namespace
}  // namespace halfshade
