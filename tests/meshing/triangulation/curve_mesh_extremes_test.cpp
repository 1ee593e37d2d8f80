#include "tests/support/curve_families.h"
#include "tests/support/curve_invariants.h"
#include "tests/support/curve_mesh_inputs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

// Rings and lines that are very close, very thin, very far away or very small.

namespace halfshade::test {
namespace {

TEST(MeshWithCurves, RingVerticesOnStraightStretchesSurviveHoweverClose) {
  const std::vector<Ring> rings = {{{0, 0},
                                    {0.25, 0},
                                    {0.25 + 1e-10, 0},
                                    {0.25 + 3e-9, 0},
                                    {0.5, 0},
                                    {1, 0},
                                    {1, 0.5 - 1e-11},
                                    {1, 0.5},
                                    {1, 1},
                                    {0, 1}}};
  const std::vector<CurvePolyline> lines = {{{{0.25, -0.1}, {0.3, 0.8}}, 0},
                                            {{{0.25 + 2e-9, 0}, {0.9, 0.5}}, 1},
                                            {{{0.1, 1e-8}, {0.9, -1e-8}}, 2},
                                            {{{1 - 2e-8, 0.2}, {1, 0.9}}, 3}};
  for (const double max_length : {0.0, 0.1}) {
    CurveMeshOptions options;
    options.quality.max_length = max_length;
    const CurveMesh mesh = mesh_with_curves(rings, {}, lines, options);
    expect_sound(mesh, rings);
    expect_follows(mesh, rings, lines, 1e-7);
  }
}

TEST(MeshWithCurves, SliversKeepTheirWidth) {
  std::vector<CurvePolyline> lines = LineFamily("Random", 5).make(50);
  for (CurvePolyline& line : lines)
    for (Vec2& p : line.points) p.y() -= 0.5;
  for (const double width : {1e-6, 1e-9, 1e-11}) {
    const std::vector<Ring> rings = {{{0, 0}, {1, 0}, {1, width}, {0, width}}};
    const CurveMesh mesh = mesh_with_curves(rings, {}, lines, unrefined());
    expect_sound(mesh, rings);
    CurveMeshOptions options;
    options.quality.max_length = 0.1;
    const CurveMesh fine = mesh_with_curves(rings, {}, lines, options);
    expect_sound(fine, rings);
    EXPECT_LE(angle_and_length(fine.mesh).second, 0.1);
  }
}

// Lines that cross a needle at so shallow an angle that they come within the snap distance of both
// its sides over a long way must not be led to and fro between them.
TEST(MeshWithCurves, ShallowLinesThroughNeedlesSettle) {
  for (const double height : {1e-3, 1e-5, 1e-7, 1e-8, 2e-9}) {
    const std::vector<Ring> rings = {{{0, 0}, {0.4, 0}, {1, 0}, {0.5, height}}};
    std::vector<CurvePolyline> lines = LineFamily("Random", 9).make(40);
    for (CurvePolyline& line : lines)
      for (Vec2& p : line.points) p.y() = 1e-5 * (p.y() - 0.5);
    const CurveMesh mesh = mesh_with_curves(rings, {}, lines, unrefined());
    EXPECT_TRUE(mesh.mesh.complete);
    EXPECT_LE(mesh.deviation, 6e-7);
    double area = 0;
    for (const auto& t : mesh.mesh.triangles) {
      Ring corners;
      for (const int p : t) corners.push_back(mesh.mesh.points[static_cast<std::size_t>(p)]);
      area += signed_area(corners);
    }
    EXPECT_NEAR(area, 0.5 * height, 1e-15) << "points on the slanted sides are rounded";
  }
}

TEST(MeshWithCurves, PointsOfContactLinesStayWhereTheyAreHoweverClose) {
  const std::vector<Segment2> contacts = {{Vec2(0.1, 0.5), Vec2(0.4, 0.5)},
                                          {Vec2(0.4, 0.5), Vec2(0.4 + 1e-9, 0.5)},
                                          {Vec2(0.4 + 1e-9, 0.5), Vec2(0.9, 0.5)}};
  const std::vector<CurvePolyline> lines = {{{{0.4 + 5e-8, 0}, {0.4 + 5e-8, 1}}, 0}};
  const CurveMesh mesh = mesh_with_curves(square, contacts, lines, {});
  std::set<std::array<double, 2>> places;
  for (const Vec2& p : mesh.mesh.points) places.insert({p.x(), p.y()});
  for (const Segment2& contact : contacts)
    for (const Vec2& p : contact) EXPECT_TRUE(places.contains({p.x(), p.y()}));
}

TEST(MeshWithCurves, HoleThatTouchesTheOutlineInAVertex) {
  const std::vector<Ring> rings = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                                   {{1, 0.5}, {0.5, 0.3}, {0.5, 0.7}}};
  const auto lines = LineFamily("Random", 8).make(30);
  const CurveMesh mesh = mesh_with_curves(rings, {}, lines, {});
  double area = 0;
  for (const auto& t : mesh.mesh.triangles) {
    Ring corners;
    for (const int p : t) corners.push_back(mesh.mesh.points[static_cast<std::size_t>(p)]);
    EXPECT_GT(signed_area(corners), 0);
    area += signed_area(corners);
  }
  EXPECT_NEAR(area, 1 - 0.1, 1e-12);
  expect_follows(mesh, rings, lines, 1e-7);
}

TEST(MeshWithCurves, FarFromTheOriginItIsTheSame) {
  // Coordinates that are exact there, too.
  const auto rounded = [](double x) { return std::round(x * 0x1p20) * 0x1p-20; };
  auto lines = LineFamily("Random", 4).make(30);
  for (CurvePolyline& line : lines)
    for (Vec2& p : line.points) p = Vec2(rounded(p.x()), rounded(p.y()));
  const CurveMesh here = mesh_with_curves(square, {}, lines, {});
  const Vec2 far(1e6, -1e6);
  std::vector<Ring> rings = square;
  for (Vec2& p : rings[0]) p += far;
  for (CurvePolyline& line : lines)
    for (Vec2& p : line.points) p += far;
  const CurveMesh there = mesh_with_curves(rings, {}, lines, {});
  expect_sound(there, rings);
  expect_follows(there, rings, lines, 1e-7);
  EXPECT_NEAR(static_cast<double>(there.mesh.triangles.size()) /
                  static_cast<double>(here.mesh.triangles.size()),
              1, 0.02);
}

TEST(MeshWithCurves, ScalesWithPowersOfTwoExactly) {
  auto lines = LineFamily("Random", 6).make(30);
  const CurveMesh unit = mesh_with_curves(square, {}, lines, {});
  for (const double scale : {0x1p-20, 0x1p10}) {
    std::vector<Ring> rings = square;
    for (Vec2& p : rings[0]) p *= scale;
    auto scaled = lines;
    for (CurvePolyline& line : scaled)
      for (Vec2& p : line.points) p *= scale;
    CurveMeshOptions options;
    options.snap *= scale;
    options.shortest *= scale;
    const CurveMesh mesh = mesh_with_curves(rings, {}, scaled, options);
    EXPECT_EQ(mesh.mesh.triangles, unit.mesh.triangles);
    EXPECT_EQ(mesh.curves, unit.curves);
  }
}

}  // namespace
}  // namespace halfshade::test
