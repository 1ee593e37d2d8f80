#include "meshing/repair/planes.h"

#include "meshing/repair/repair.h"
#include "meshing/repair/weld.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace halfshade {
namespace {

TEST(Weld, JoinsVerticesAsCloseAsTheirRoundingAndLeavesOutUnusedOnes) {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  for (int k = 0; k < 50; ++k) {
    const Vec3 p(0.1 * k, 0.0137 * k, 1 - 0.01 * k);
    test::add_polygon(scene, {p, p + Vec3(5e-10, -4e-10, 3e-10), p + Vec3(0, 2e-3, 0)}, 0);
  }
  scene.vertices.emplace_back(7, 7, 7);
  const WeldedVertices welded = weld(scene);
  EXPECT_EQ(welded.points.size(), 100u);
  EXPECT_EQ(welded.of_vertex.back(), -1);
  for (std::size_t v = 0; v + 1 < scene.vertices.size(); v += 3) {
    EXPECT_EQ(welded.of_vertex[v], welded.of_vertex[v + 1]);
    EXPECT_NE(welded.of_vertex[v], welded.of_vertex[v + 2]);
  }
}

TEST(Weld, KeepsCornersOfTinyFacesApart) {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  const double w = 1e-9;
  test::add_polygon(scene, {{0, 0, 1}, {w, 0, 1}, {w, w, 1}, {0, w, 1}}, 0);
  EXPECT_EQ(weld(scene).points.size(), 4u);
}

/// Triangles over one place, at heights and facing up or down.
struct Sheets {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> loops;

  std::vector<bool> two_sided;

  void add(double z, bool up, double x = 0, double size = 1) {
    const int first = static_cast<int>(points.size());
    for (const Vec2& p : {Vec2(0, 0), Vec2(size, 0), Vec2(0, size)})
      points.emplace_back(x + p.x(), p.y(), z);
    loops.push_back(up ? std::vector<int>{first, first + 1, first + 2}
                       : std::vector<int>{first, first + 2, first + 1});
    two_sided.push_back(false);
  }
  PlaneClasses classes() const {
    std::vector<LocalScale> scales;
    for (const std::vector<int>& loop : loops)
      scales.push_back(scale_of(std::span(points).subspan(at(loop[0]), 3)));
    return classify_planes(points, loops, scales, two_sided);
  }
};

TEST(ClassifyPlanes, ThatLookTheSameWayAreOneToWithinTheRoundingOfAFile) {
  Sheets sheets;
  sheets.add(0, true), sheets.add(3e-7, true), sheets.add(1e-3, true);
  const PlaneClasses classes = sheets.classes();
  EXPECT_EQ(classes.frames.size(), 2u);
  EXPECT_EQ(classes.of_polygon[0], classes.of_polygon[1]);
  EXPECT_NE(classes.of_polygon[0], classes.of_polygon[2]);
  for (std::size_t i = 0; i < sheets.loops.size(); ++i)
    for (const int p : sheets.loops[i])
      EXPECT_LE(std::abs(classes.frames[at(classes.of_polygon[i])].height(sheets.points[at(p)])),
                1e-6);
}

TEST(ClassifyPlanes, OfASheetAboveAFloorAreTwoHoweverNarrowTheGap) {
  for (const double gap : {1e-5, 1e-6, 3e-7, 1e-8}) {
    Sheets sheets;
    sheets.add(0, true), sheets.add(gap, true), sheets.add(gap, false);
    const PlaneClasses classes = sheets.classes();
    EXPECT_EQ(classes.frames.size(), 2u) << gap;
    EXPECT_EQ(classes.of_polygon[1], classes.of_polygon[2]) << gap;
    EXPECT_NE(classes.of_polygon[0], classes.of_polygon[1]) << gap;
  }
  // The back of the floor itself is no reason.
  Sheets slab;
  slab.add(0, true), slab.add(0, false), slab.add(3e-7, true);
  const PlaneClasses classes = slab.classes();
  EXPECT_EQ(classes.of_polygon[0], classes.of_polygon[2]);
}

TEST(ClassifyPlanes, OfATwoSidedSheetOverOrUnderAFloorAreTwoWhicheverWayItLooks) {
  for (const double gap : {1e-3, 1e-6, 3e-7, 1e-8, -1e-8, -3e-7})
    for (const bool up : {true, false}) {
      Sheets sheets;
      sheets.add(0, true), sheets.add(gap, up);
      sheets.two_sided[1] = true;
      EXPECT_EQ(sheets.classes().frames.size(), 2u) << gap << up;
    }
  for (const bool up : {true, false}) {
    Sheets flush;
    flush.add(1, true), flush.add(1, up);
    flush.two_sided[1] = true;
    EXPECT_EQ(flush.classes().frames.size(), 1u) << up;
  }
}

TEST(ClassifyPlanes, OnBothSidesOfATwoSidedSheetAreTwo) {
  Sheets sheets;
  sheets.add(0, true), sheets.add(3e-7, true), sheets.add(6e-7, true);
  sheets.two_sided[1] = true;
  const PlaneClasses classes = sheets.classes();
  EXPECT_NE(classes.of_polygon[0], classes.of_polygon[1]);
  EXPECT_NE(classes.of_polygon[0], classes.of_polygon[2]);
}

TEST(ClassifyPlanes, BackToBackAreOneWhereTheyCutThroughEachOther) {
  // In all digits: what fewer cannot tell is one in any case.
  constexpr double digits = 1.23456789012345;
  const auto count = [](double tilt, double height) {
    Sheets sheets;
    sheets.add(0, true), sheets.add(digits * height, false);
    sheets.points[4].z() += digits * tilt;
    sheets.points[5].z() -= digits * tilt;
    return sheets.classes().frames.size();
  };
  EXPECT_EQ(count(1e-7, 0), 1u);
  EXPECT_EQ(count(1e-7, 5e-8), 1u);
  EXPECT_EQ(count(1e-7, 2e-7), 2u) << "a gap, if a slanted one";
  EXPECT_EQ(count(1e-4, 0), 2u) << "more than rounding does";
  // Beside each other they cut through nothing.
  Sheets beside;
  beside.add(0, true), beside.add(0, false, 1);
  beside.points[4].z() += digits * 1e-7;
  beside.points[5].z() -= digits * 1e-7;
  EXPECT_EQ(beside.classes().frames.size(), 2u);
}

TEST(ClassifyPlanes, ThatFaceEachOtherAreTwoHoweverNarrowTheGap) {
  for (const double gap : {1e-3, 1e-6, 1e-7, 1e-8}) {
    Sheets sheets;
    sheets.add(0, true), sheets.add(gap, false);
    EXPECT_EQ(sheets.classes().frames.size(), 2u) << gap;
  }
  Sheets coincident;
  coincident.add(1, true), coincident.add(1, false);
  EXPECT_EQ(coincident.classes().frames.size(), 1u);
}

// A foot on a floor, both turned: rounding lifts or sinks it.
TEST(ClassifyPlanes, ThatFaceEachOtherAreOneIfTheirDigitsTellOfNoGap) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  const auto in_single = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  const auto in_six_digits = [](double x) { return std::round(x * 1e6) / 1e6; };
  const auto as_it_is = [](double x) { return x; };
  const auto planes = [&](double gap, const auto& rounded) {
    Sheets sheets;
    sheets.add(0, true, 0, 4);
    sheets.add(gap, false, 1, 0.1);
    for (Vec3& p : sheets.points) p = (turn * p).unaryExpr(rounded);
    return sheets.classes().frames.size();
  };
  EXPECT_EQ(planes(0, in_single), 1u);
  EXPECT_EQ(planes(0, in_six_digits), 1u);
  EXPECT_EQ(planes(1e-7, in_single), 1u);
  EXPECT_EQ(planes(1e-7, as_it_is), 2u);
  EXPECT_EQ(planes(1e-5, in_single), 2u);
  EXPECT_EQ(planes(1e-5, in_six_digits), 2u);
}

TEST(ClassifyPlanes, AreNotJoinedAcrossADistance) {
  Sheets sheets;
  sheets.add(0, true), sheets.add(0, true, 0.5), sheets.add(0, true, 3);
  const PlaneClasses classes = sheets.classes();
  EXPECT_EQ(classes.of_polygon[0], classes.of_polygon[1]);
  EXPECT_NE(classes.of_polygon[0], classes.of_polygon[2]);
}

TEST(ClassifyPlanes, DoNotDependOnWhatIsElsewhere) {
  for (const double far : {1e3, 1e6, 1e9}) {
    Sheets sheets;
    sheets.add(0, true), sheets.add(1e-4, true);
    sheets.add(far, false, far, far);
    const PlaneClasses classes = sheets.classes();
    EXPECT_EQ(classes.frames.size(), 3u) << far;
  }
}

/// A seat, nearly flat, of quadrangles with a front and a back each, as modelled with six digits.
Scene seat_with_fronts_and_backs() {
  constexpr int across = 12;
  constexpr double width = 0.04;
  test::Random random(5);
  std::vector<std::vector<double>> height(across + 1, std::vector<double>(across + 1));
  for (auto& row : height)
    for (double& z : row) z = 0.911360 + 1e-6 * random.integer(0, 8);
  Scene scene;
  test::add_material(scene, 0.5, 0);
  const auto corner = [&](int i, int j) {
    return Vec3(1.4 + width * i, 1.3 + width * j, height[at(i)][at(j)]);
  };
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      std::vector<Vec3> quad = {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                corner(i, j + 1)};
      test::add_polygon(scene, quad, 0);
      std::reverse(quad.begin(), quad.end());
      test::add_polygon(scene, quad, 0);
    }
  return scene;
}

// In two planes each might lie before the other, and hide all light from it.
TEST(ClassifyPlanes, OfAFrontAndABackBetweenTheSameCornersAreOne) {
  const Scene scene = seat_with_fronts_and_backs();
  const SoundScene sound = make_sound(scene);
  std::vector<std::set<int>> planes(scene.faces.size());
  for (const Surface& surface : sound.surfaces)
    for (const int face : surface.faces) planes[at(face)].insert(surface.plane);
  for (std::size_t front = 0; front < planes.size(); front += 2)
    EXPECT_EQ(planes[front], planes[front + 1]) << front;
}

}  // namespace
}  // namespace halfshade
