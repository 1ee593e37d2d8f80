#include "meshing/triangulation/curve_mesh.h"

#include "tests/support/curve_families.h"
#include "tests/support/curve_invariants.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace halfshade::test {
namespace {

const std::vector<Ring> square = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
const std::vector<Ring> notched = {
    {{0, 0}, {1, 0}, {1, 1}, {0.6, 0.3}, {0, 1}},
    {{0.2, 0.2}, {0.2, 0.4}, {0.3, 0.4}, {0.35, 0.2}},
    {{0.7, 0.1}, {0.65, 0.25}, {0.9, 0.2}},
};

CurveMeshOptions unrefined() {
  CurveMeshOptions options;
  options.quality.min_angle = 0;
  return options;
}

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

class CurveMeshFamily : public testing::TestWithParam<std::tuple<const char*, unsigned>> {
 protected:
  std::vector<CurvePolyline> lines(int n) const {
    return LineFamily(std::get<0>(GetParam()), std::get<1>(GetParam())).make(n);
  }
};

TEST_P(CurveMeshFamily, UnrefinedMeshIsSoundAndFollowsTheLines) {
  const auto given = lines(60);
  for (const auto& rings : {square, notched}) {
    const CurveMesh mesh = mesh_with_curves(rings, {}, given, unrefined());
    expect_sound(mesh, rings);
    expect_follows(mesh, rings, given, 1e-7);
    EXPECT_TRUE(mesh.mesh.complete);
  }
}

TEST_P(CurveMeshFamily, RefinedMeshIsSoundAndFollowsTheLines) {
  const auto given = lines(60);
  CurveMeshOptions options;
  options.quality.max_length = 0.3;
  for (const auto& rings : {square, notched}) {
    const CurveMesh mesh = mesh_with_curves(rings, {}, given, options);
    expect_sound(mesh, rings);
    expect_follows(mesh, rings, given, 1e-7);
    EXPECT_TRUE(mesh.mesh.complete);
    EXPECT_LE(angle_and_length(mesh.mesh).second, 0.3);
  }
}

TEST_P(CurveMeshFamily, RefinementMakesNoShorterEdgesThanAsked) {
  const auto given = lines(40);
  const CurveMesh coarse = mesh_with_curves(notched, {}, given, unrefined());
  std::set<std::array<double, 2>> there;
  for (const Vec2& p : coarse.mesh.points) there.insert({p.x(), p.y()});
  CurveMeshOptions options;
  options.shortest = 2e-3;
  const CurveMesh mesh = mesh_with_curves(notched, {}, given, options);
  for (const auto& t : mesh.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = place_of(mesh.mesh, {t[k], t[(k + 1) % 3]});
      if (!there.contains({a.x(), a.y()})) {
        EXPECT_GE((b - a).norm(), 2e-3 * (1 - 1e-12));
      }
    }
}

TEST_P(CurveMeshFamily, SameInputSameBytes) {
  const auto given = lines(40);
  const CurveMesh a = mesh_with_curves(notched, {}, given, {});
  const CurveMesh b = mesh_with_curves(notched, {}, given, {});
  EXPECT_EQ(a.mesh.points, b.mesh.points);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.mesh.constrained_edges, b.mesh.constrained_edges);
  EXPECT_EQ(a.curves, b.curves);
}

// The border is meant to be meshed again and again until neighbours agree on its points.
TEST_P(CurveMeshFamily, ItsOwnBorderPointsGivenBackHardlyAddAny) {
  const auto given = lines(30);
  std::vector<Ring> rings = square;
  std::size_t before = 0, after = 0;
  for (int round = 0; round < 4; ++round) {
    const CurveMesh mesh = mesh_with_curves(rings, {}, given, {});
    std::array<std::vector<Vec2>, 4> sides;
    for (const Vec2& p : mesh.mesh.points) {
      if (p.y() == 0 && p.x() < 1) sides[0].push_back(p);
      if (p.x() == 1 && p.y() < 1) sides[1].push_back(p);
      if (p.y() == 1 && p.x() > 0) sides[2].push_back(p);
      if (p.x() == 0 && p.y() > 0) sides[3].push_back(p);
    }
    const std::array<Vec2, 4> onward = {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)};
    Ring ring;
    for (std::size_t k = 0; k < 4; ++k) {
      std::sort(sides[k].begin(), sides[k].end(),
                [&](const Vec2& a, const Vec2& b) { return a.dot(onward[k]) < b.dot(onward[k]); });
      ring.insert(ring.end(), sides[k].begin(), sides[k].end());
    }
    expect_sound(mesh_with_curves(std::vector<Ring>{ring}, {}, given, {}), {ring});
    before = after;
    after = ring.size();
    if (round == 1) {
      EXPECT_LE(after, before + 2 + before / 20);
    }
    rings = {ring};
  }
  EXPECT_EQ(after, before) << "it settles";
}

INSTANTIATE_TEST_SUITE_P(Families, CurveMeshFamily,
                         testing::Combine(testing::Values("Random", "Concurrent", "NearParallel",
                                                          "AxisAligned", "ConicTangent", "Fan",
                                                          "Offset", "Coincident", "AlongTheBorder"),
                                          testing::Values(1U, 2U, 3U)),
                         [](const auto& name) {
                           return std::get<0>(name.param) + std::to_string(std::get<1>(name.param));
                         });

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

TEST(MeshWithCurves, LinesOutsideAreLeftOutAndThoseOverTheBorderCut) {
  const std::vector<CurvePolyline> lines = {
      {{{2, 0}, {2, 1}}, 0}, {{{0.5, 0.5}, {9, 0.5}}, 1}, {{{1.2, -1}, {1.0005, 3}}, 2}};
  const CurveMesh mesh = mesh_with_curves(square, {}, lines, unrefined());
  expect_sound(mesh, square);
  EXPECT_EQ(std::set<int>(mesh.curves.begin(), mesh.curves.end()), std::set<int>{1});
  EXPECT_EQ(mesh.mesh.points.size(), 6U);
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
