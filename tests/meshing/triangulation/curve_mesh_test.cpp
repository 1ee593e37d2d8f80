#include "meshing/triangulation/curve_mesh.h"

#include "tests/support/curve_families.h"
#include "tests/support/curve_invariants.h"
#include "tests/support/curve_mesh_inputs.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace halfshade::test {
namespace {

double area_with_angle_below(const PlanarMesh& mesh, double degrees) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    PlanarMesh one;
    one.points = mesh.points;
    one.triangles = {t};
    Ring corners;
    for (const int p : t) corners.push_back(mesh.points[static_cast<std::size_t>(p)]);
    if (angle_and_length({corners, {{0, 1, 2}}, {}, true}).first < degrees)
      sum += signed_area(corners);
  }
  return sum;
}

TEST(MeshWithCurves, ShadowOfASquareUnderASquareHasTwentyFiveRegions) {
  // A light [−½,½]² at z = 2 over an occluder [−3/8,3/8]² at z = 1. A corner coordinate of the
  // occluder ±3/8 seen from one of the light ±1/2 falls on z = 0 at 2 (±3/8) − (±1/2).
  const std::vector<Ring> floor = {
      {{-1.9371, -1.9371}, {1.8613, -1.9371}, {1.8613, 1.8613}, {-1.9371, 1.8613}}};
  std::vector<CurvePolyline> lines;
  for (const double c : {-1.25, -0.25, 0.25, 1.25}) {
    lines.push_back({{{c, -3}, {c, 3}}, static_cast<int>(lines.size())});
    lines.push_back({{{-3, c}, {3, c}}, static_cast<int>(lines.size())});
  }
  const CurveMesh mesh = mesh_with_curves(floor, {}, lines, unrefined());
  expect_sound(mesh, floor);
  EXPECT_EQ(region_count(mesh), 25);
  EXPECT_LE(mesh.deviation, 1e-15);
  EXPECT_EQ(mesh.mesh.points.size(), 36U);
  CurveMeshOptions options;
  options.quality.max_length = 0.2;
  const CurveMesh fine = mesh_with_curves(floor, {}, lines, options);
  expect_sound(fine, floor);
  EXPECT_EQ(region_count(fine), 25);
  EXPECT_GE(angle_and_length(fine.mesh).first, 20.699);
}

TEST(MeshWithCurves, WithoutCurvesIsAPlainMesh) {
  const CurveMesh mesh = mesh_with_curves(notched, {}, {}, unrefined());
  expect_sound(mesh, notched);
  EXPECT_EQ(mesh.mesh.points.size(), notched[0].size() + notched[1].size() + notched[2].size());
  EXPECT_TRUE(mesh.curves.empty());
  EXPECT_EQ(region_count(mesh), 1);
}

TEST(MeshWithCurves, EdgesKnowEveryLineAlongThem) {
  const std::vector<CurvePolyline> lines = {{{{0.1, 0.5}, {0.7, 0.5}}, 4},
                                            {{{0.9, 0.5 + 2e-8}, {0.3, 0.5 - 2e-8}}, 2},
                                            {{{0.2, 0.5}, {0.4, 0.5}, {0.4, 0.9}}, 4},
                                            {{{0.3, 0}, {0.6, 0}}, 7}};
  const CurveMesh mesh = mesh_with_curves(square, {}, lines, unrefined());
  std::map<std::vector<int>, double> length;
  for (std::size_t e = 0; e < mesh.is_d0.size(); ++e) {
    const auto [a, b] = place_of(mesh.mesh, mesh.mesh.constrained_edges[e]);
    std::vector<int> ids(mesh.curves.begin() + mesh.curve_begin[e],
                         mesh.curves.begin() + mesh.curve_begin[e + 1]);
    if (mesh.is_d0[e]) ids.push_back(-1);
    length[ids] += (b - a).norm();
  }
  ASSERT_EQ(length.size(), 5U);
  EXPECT_NEAR((length[{4}]), 0.2 + 0.4, 1e-6);
  EXPECT_NEAR((length[{2, 4}]), 0.4, 1e-6);
  EXPECT_NEAR((length[{2}]), 0.2, 1e-6);
  EXPECT_NEAR((length[{7, -1}]), 0.3, 1e-6);
  EXPECT_NEAR((length[{-1}]), 3.7, 1e-6);
}

TEST(MeshWithCurves, AnglesAreGoodAwayFromNarrowInputAngles) {
  CurveMeshOptions options;
  options.shortest = 1e-6;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const auto lines = LineFamily("Random", seed).make(30);
    const CurveMesh mesh = mesh_with_curves(square, {}, lines, options);
    EXPECT_LE(area_with_angle_below(mesh.mesh, 20.699), 0.01);
    EXPECT_LE(area_with_angle_below(mesh.mesh, 1), 1e-6);
  }
  // Lines that meet at right angles or not at all leave no excuse anywhere.
  std::vector<CurvePolyline> lines = LineFamily("AxisAligned", 1).make(40);
  std::erase_if(lines, [](const CurvePolyline& line) { return line.id % 4 == 0; });
  const CurveMesh mesh = mesh_with_curves(square, {}, lines, options);
  EXPECT_GE(angle_and_length(mesh.mesh).first, 20.699);
}

TEST(MeshWithCurves, ContactLinesAreKeptAlsoWhereCurvesRunAlongThem) {
  const std::vector<Segment2> contacts = {{Vec2(0.1, 0.5), Vec2(0.9, 0.5)},
                                          {Vec2(0.5, 0.1), Vec2(0.5, 0.9)},
                                          {Vec2(0, 0.2), Vec2(1, 0.2)}};
  auto lines = LineFamily("Random", 3).make(20);
  for (CurvePolyline& line : lines) line.id += 2;
  lines.push_back({{{0.2, 0.5 + 3e-8}, {0.6, 0.5 - 3e-8}}, 0});
  lines.push_back({{{0.5, -1}, {0.5, 2}}, 1});
  for (const double max_length : {0.0, 0.1}) {
    CurveMeshOptions options;
    options.quality.max_length = max_length;
    const CurveMesh mesh = mesh_with_curves(square, contacts, lines, options);
    expect_sound(mesh, square, contacts);
    expect_follows(mesh, square, lines, 1e-7);
  }
}

TEST(MeshWithCurves, ContactLinesGivenTwiceAreOne) {
  const Segment2 contact = {Vec2(0.1, 0.3), Vec2(0.9, 0.5)};
  const CurveMesh once = mesh_with_curves(square, {{contact}}, {}, unrefined());
  const CurveMesh twice =
      mesh_with_curves(square, {{contact, {contact[1], contact[0]}}}, {}, unrefined());
  EXPECT_EQ(once.mesh.triangles, twice.mesh.triangles);
  expect_sound(twice, square, {contact});
}

TEST(MeshWithCurves, LinesOutsideAreLeftOutAndThoseOverTheBorderCut) {
  const std::vector<CurvePolyline> lines = {
      {{{2, 0}, {2, 1}}, 0}, {{{0.5, 0.5}, {9, 0.5}}, 1}, {{{1.2, -1}, {1.0005, 3}}, 2}};
  const CurveMesh mesh = mesh_with_curves(square, {}, lines, unrefined());
  expect_sound(mesh, square);
  EXPECT_EQ(std::set<int>(mesh.curves.begin(), mesh.curves.end()), std::set<int>{1});
  EXPECT_EQ(mesh.mesh.points.size(), 6U);
}

TEST(MeshWithCurves, TriangleLimitEndsWithASoundMesh) {
  CurveMeshOptions options;
  options.quality.max_length = 0.01;
  options.quality.max_triangles = 1000;
  const auto lines = LineFamily("Random", 7).make(10);
  const CurveMesh mesh = mesh_with_curves(notched, {}, lines, options);
  EXPECT_FALSE(mesh.mesh.complete);
  expect_sound(mesh, notched);
  expect_follows(mesh, notched, lines, 1e-7);
}

TEST(MeshWithCurves, NoRingsNoTriangles) {
  const CurveMesh mesh = mesh_with_curves({}, {}, {}, {});
  EXPECT_TRUE(mesh.mesh.triangles.empty());
  EXPECT_EQ(mesh.curve_begin, std::vector<int>{0});
}

TEST(MeshWithCurves, RejectsOptionsAndLinesOutOfRange) {
  const auto fails = [](auto change, const std::string& part) {
    CurveMeshOptions options;
    change(options);
    expect_error([&] { mesh_with_curves(square, {}, {}, options); }, ErrorCode::contract, {part});
  };
  fails([](auto& o) { o.quality.max_length = -1; }, "max_length is -1");
  fails([](auto& o) { o.quality.min_angle = 30; }, "min_angle is 30");
  fails([](auto& o) { o.snap = 0; }, "snap is 0");
  fails([](auto& o) { o.shortest = o.snap; }, "shortest is 1e-07");
  expect_error(
      [] {
        mesh_with_curves(square, {}, {{CurvePolyline{{{0, NAN}, {1, 1}}, 3}}}, {});
      },
      ErrorCode::contract, {"curve 3"});
  expect_error(
      [] {
        mesh_with_curves(square, {}, {{CurvePolyline{{{0, 0}, {1, 1}}, -1}}}, {});
      },
      ErrorCode::contract, {"-1"});
}

}  // namespace
}  // namespace halfshade::test
