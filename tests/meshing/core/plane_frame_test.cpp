#include "meshing/core/plane_frame.h"

#include "meshing/core/error.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace halfshade {
namespace {

using std::numbers::pi;
using Polygon = std::vector<Vec3>;

double area(const Polygon& polygon) { return area_vector(polygon).norm(); }

Polygon regular(int corners, double radius) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i)
    polygon.emplace_back(radius * std::cos(2 * pi * i / corners),
                         radius * std::sin(2 * pi * i / corners), 0);
  return polygon;
}

Polygon moved(const Polygon& polygon, const Eigen::Affine3d& motion) {
  Polygon result;
  for (const Vec3& p : polygon) result.push_back(motion * p);
  return result;
}

const Polygon unit_square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return Vec3(x, y, z).normalized();
}

TEST(AreaVector, IsThatOfARegularPolygon) {
  for (const int n : {3, 4, 5, 6, 17, 1000}) {
    const Vec3 a = area_vector(regular(n, 1.5));
    EXPECT_NEAR(a.z(), 0.5 * n * 1.5 * 1.5 * std::sin(2 * pi / n), 1e-12);
    EXPECT_EQ(a.x(), 0);
    EXPECT_EQ(a.y(), 0);
  }
}

TEST(AreaVector, CountsANonConvexPolygonOnce) {
  // An L: 2 × 2 less 1 × 1, starting at its inner corner, where a fan leaves the polygon.
  const Polygon shape = {{1, 1, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}};
  EXPECT_EQ(area_vector(shape), Vec3(0, 0, 3));
}

TEST(AreaVector, TurnsWithThePolygonAndFlipsWithItsOrder) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const Vec3 axis = random_direction(random);
    Eigen::Affine3d motion = Eigen::Translation3d(10 * random_direction(random)) *
                             Eigen::AngleAxisd(i * 0.3, axis) * Eigen::Scaling(2.0);
    const Polygon polygon = regular(5, 1);
    const Polygon turned = moved(polygon, motion);
    EXPECT_NEAR((area_vector(turned) - 2 * (motion.linear() * area_vector(polygon))).norm(), 0,
                1e-13);
    EXPECT_NEAR((area_vector(Polygon(turned.rbegin(), turned.rend())) + area_vector(turned)).norm(),
                0, 1e-13);
  }
}

TEST(AreaVector, KeepsItsDigitsFarFromTheOrigin) {
  // 2^20 steps are exact, so nothing may be lost.
  const Polygon far = moved(unit_square, Eigen::Affine3d(Eigen::Translation3d(1e6, -1e6, 1e6)));
  EXPECT_EQ(area_vector(far), Vec3(0, 0, 1));
}

TEST(AreaVector, SumsToZeroOverAClosedSurface) {
  // A tetrahedron with non-trivial corners, looking outwards.
  const Vec3 a(0.1, 0.2, 0.3), b(1.7, 0.1, -0.4), c(0.3, 2.1, 0.2), d(0.4, 0.6, 1.9);
  const Vec3 sum = area_vector(Polygon{a, c, b}) + area_vector(Polygon{a, b, d}) +
                   area_vector(Polygon{b, c, d}) + area_vector(Polygon{c, a, d});
  EXPECT_NEAR(sum.norm(), 0, 1e-15);
}

TEST(MakeFrame, IsRightHandedAndOrthonormalForAnyNormal) {
  std::mt19937 random(2);
  std::vector<Vec3> normals = {Vec3::UnitX(),  Vec3::UnitY(),  Vec3::UnitZ(),
                               -Vec3::UnitX(), -Vec3::UnitY(), -Vec3::UnitZ(),
                               Vec3::Ones(),   {1, 1e-9, 0},   {1e-200, 1e-200, 1e-200}};
  for (int i = 0; i < 200; ++i) normals.push_back(std::exp(i - 100) * random_direction(random));
  for (const Vec3& normal : normals) {
    const PlaneFrame frame = make_frame({1, 2, 3}, normal);
    Eigen::Matrix3d axes;
    axes << frame.e1, frame.e2, frame.normal;
    EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-14)) << normal.transpose();
    EXPECT_NEAR(axes.determinant(), 1, 1e-14);
    EXPECT_NEAR(frame.normal.dot(normal.stableNormalized()), 1, 1e-14);
  }
}

TEST(MakeFrame, HasAxesThatDependOnTheDirectionAlone) {
  const PlaneFrame a = make_frame({0, 0, 0}, {1, 2, -2});
  const PlaneFrame b = make_frame({7, -5, 3}, {4, 8, -8});
  EXPECT_EQ(a.e1, b.e1);
  EXPECT_EQ(a.e2, b.e2);
}

TEST(MakeFrame, RefusesANormalWithoutLength) {
  EXPECT_THROW(make_frame(Vec3::Zero(), Vec3::Zero()), Error);
  EXPECT_THROW(make_frame(Vec3::Zero(), Vec3::Constant(NAN)), Error);
}

TEST(PlaneFrame, ToSpaceUndoesToPlaneInThePlane) {
  const PlaneFrame frame = make_frame({1, 2, 3}, {0.3, -0.4, 0.5});
  for (const Vec2& q : {Vec2(0, 0), Vec2(1.5, -2), Vec2(-1e3, 1e3)}) {
    const Vec3 p = frame.to_space(q);
    EXPECT_NEAR(frame.height(p), 0, 1e-12);
    EXPECT_NEAR((frame.to_plane(p) - q).norm(), 0, 1e-12);
    EXPECT_NEAR(frame.height(p + 2 * frame.normal), 2, 1e-12);
  }
}

TEST(FitPlane, ContainsAPlanarPolygonAndLooksToItsFront) {
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Affine3d motion =
        Eigen::Translation3d(5 * random_direction(random)) *
        Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), random_direction(random));
    const Polygon polygon = moved(regular(7, 2), motion);
    const PlaneFrame frame = fit_plane(polygon);
    for (const Vec3& p : polygon) EXPECT_NEAR(frame.height(p), 0, 1e-14);
    EXPECT_NEAR((frame.normal - motion.linear() * Vec3::UnitZ()).norm(), 0, 1e-14);
    EXPECT_NEAR((frame.origin - motion.translation()).norm(), 0, 1e-14);
  }
}

TEST(ClipToFront, KeepsTheKnownAreaOfASquare) {
  // The square below the line x + y = s has the area s²/2 up to s = 1, then 1 − (2 − s)²/2.
  for (int i = 1; i < 20; ++i) {
    const double s = 0.1 * i;
    const Polygon part = clip_to_front(unit_square, {s, 0, 0}, {-1, -1, 0});
    EXPECT_NEAR(area(part), s <= 1 ? s * s / 2 : 1 - (2 - s) * (2 - s) / 2, 1e-15) << s;
  }
}

TEST(ClipToFront, CutsAPolygonIntoTwoPartsOfItsArea) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> offset(-1, 1);
  for (int i = 0; i < 500; ++i) {
    const Polygon polygon = regular(3 + i % 9, 1);
    const Vec3 normal = 3 * random_direction(random);
    const Vec3 point(offset(random), offset(random), offset(random));
    const Polygon front = clip_to_front(polygon, point, normal);
    const Polygon back = clip_to_front(polygon, point, -normal);
    EXPECT_NEAR(area(front) + area(back), area(polygon), 1e-14);
    for (const Vec3& p : front) EXPECT_GE(normal.dot(p - point), -1e-14);
    EXPECT_TRUE(front.empty() || area_vector(front).z() > 0);  // the order is kept
  }
}

TEST(ClipToFront, KeepsAllOrNothingOfAPolygonOnOneSide) {
  EXPECT_EQ(clip_to_front(unit_square, {0, 0, -1}, {0, 0, 1}), unit_square);
  EXPECT_TRUE(clip_to_front(unit_square, {0, 0, 1}, {0, 0, 1}).empty());
}

TEST(ClipToFront, DropsWhatOnlyTouchesThePlane) {
  EXPECT_TRUE(clip_to_front(unit_square, {0, 0, 0}, {0, 0, 1}).empty());  // all of it
  EXPECT_TRUE(clip_to_front(unit_square, {1, 0, 0}, {1, 0, 0}).empty());  // an edge
  EXPECT_TRUE(clip_to_front(unit_square, {1, 1, 0}, {1, 1, 0}).empty());  // a corner
}

TEST(ClipToFront, KeepsCornersOnThePlaneOnce) {
  const Polygon half = clip_to_front(unit_square, {0, 0, 0}, {1, -1, 0});
  EXPECT_EQ(half, (Polygon{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
  EXPECT_EQ(clip_to_front(unit_square, {0, 0, 0}, {1, 0, 0}), unit_square);
}

}  // namespace
}  // namespace halfshade
