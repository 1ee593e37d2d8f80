#include "meshing/core/rounded.h"
#include "solver/pipeline/solve.h"
#include "tests/support/named_scene.h"
#include "tests/support/own_corners.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stop_token>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

// The laws for all light, as `solve` finds it. Another order of faces and vertices changes no bit,
// nor do powers of two; another unit of length, and what is far away or tiny, change nothing but
// for rounding. What is about a thousand sizes away may move rays, within the tolerance.

namespace halfshade {
namespace {

constexpr double tolerance = 0.01;

std::vector<std::string> scenes() {
  std::vector<std::string> names = {"cornell_box", "furnace_cube", "l_room", "reading_room",
                                    "thermal_furnace"};
  for (int seed = 0; seed < 50; seed += 5) names.push_back("random_" + std::to_string(seed));
  return names;
}

/// All that are solved in about a second.
std::vector<std::string> more_scenes() {
  std::vector<std::string> names = {
      "bars",         "cornell_box", "furnace_cube", "holed_light",      "l_room",
      "reading_room", "s1",          "skew_bars",    "table_and_chairs", "thermal_furnace"};
  for (int seed = 0; seed < 50; ++seed) names.push_back("random_" + std::to_string(seed));
  return names;
}

/// Of lengths. Random scenes are many, and each has two of them.
std::vector<double> units(const std::string& name) {
  std::vector<double> all = {3, 1e-3, 1e9, 1e-30};
  if (!name.starts_with("random_")) return all;
  return {all[0], all[1 + std::stoul(name.substr(7)) % 3]};
}

SolveResult solved(const Scene& scene) {
  SolveOptions options;
  options.tolerance = tolerance;
  SolveResult result = solve(scene, options);
  EXPECT_EQ(result.not_reached, "");
  return result;
}

/// Power that arrives at the faces of each material of `like`, W.
std::vector<Rgb> powers(const SolveResult& result, const Scene& like) {
  std::vector<Rgb> power(like.materials.size(), Rgb::Zero());
  for (int e = 0; e < result.elements.count(); ++e) {
    const auto m = static_cast<std::size_t>(result.elements.material[static_cast<std::size_t>(e)]);
    if (m >= power.size()) continue;
    power[m] += result.elements.area[static_cast<std::size_t>(e)] *
                result.solution.irradiance.row(e).transpose();
  }
  return power;
}

double norm(const std::vector<Rgb>& values) {
  double sum = 0;
  for (const Rgb& value : values) sum += value.square().sum();
  return std::sqrt(sum);
}

void expect_near(const std::vector<Rgb>& expected, const std::vector<Rgb>& got,
                 const std::string& what, double within = 2 * tolerance) {
  std::vector<Rgb> off = expected;
  for (std::size_t i = 0; i < off.size(); ++i) off[i] -= got[i];
  EXPECT_LE(norm(off), within * norm(expected)) << what;
}

/// The elements of all but the triangle elsewhere, by their middles: how they are numbered may
/// change.
std::vector<int> by_place(const SolveResult& result) {
  std::vector<std::pair<std::array<double, 3>, int>> places;
  for (int e = 0; e < result.elements.count(); ++e) {
    if (result.scene.materials[at(result.elements.material[at(e)])].name == "elsewhere") continue;
    const auto corners = result.elements.triangle(e);
    const Vec3 sum = corners[0] + corners[1] + corners[2];
    places.push_back({{rounded(sum.x()), rounded(sum.y()), rounded(sum.z())}, e});
  }
  std::sort(places.begin(), places.end());
  std::vector<int> elements;
  for (const auto& [place, e] : places) elements.push_back(e);
  return elements;
}

/// Between elements of the same places, but for those of the triangle elsewhere.
double largest_difference(const SolveResult& expected, const SolveResult& got) {
  const std::vector<int> before = by_place(expected), after = by_place(got);
  EXPECT_EQ(after.size(), before.size());
  double worst = 0;
  for (std::size_t k = 0; k < std::min(before.size(), after.size()); ++k)
    worst = std::max(
        worst, (got.solution.irradiance.row(after[k]) - expected.solution.irradiance.row(before[k]))
                   .abs()
                   .maxCoeff());
  return worst;
}

class ReflectedLaws : public testing::TestWithParam<std::string> {
 protected:
  const Scene scene_ = test::named_scene(GetParam());
  const SolveResult expected_ = solved(scene_);
};

class AllLightLaws : public ReflectedLaws {};

TEST_P(ReflectedLaws, PowersOfTwoChangeNoBit) {
  Scene scene = scene_;
  for (Vec3& p : scene.vertices) p *= 0x1p-40;
  for (Material& material : scene.materials) material.exitance *= 0x1p60;
  const SolveResult result = solved(scene);
  ASSERT_EQ(result.elements.count(), expected_.elements.count());
  EXPECT_TRUE((result.solution.irradiance == 0x1p60 * expected_.solution.irradiance).all());
  EXPECT_EQ(result.relative_error, expected_.relative_error);
}

TEST_P(AllLightLaws, AreTheSameInAnyUnit) {
  double exitance = 0;
  for (const Material& material : scene_.materials)
    exitance = std::max(exitance, material.exitance.maxCoeff());
  for (const double unit : units(GetParam())) {
    const std::string what = "times 10^" + std::to_string(std::log10(unit));
    Scene scene = scene_;
    for (Vec3& p : scene.vertices) p *= unit;
    const SolveResult result = solved(scene);
    ASSERT_TRUE(result.elements.corners == expected_.elements.corners) << what;
    const auto off = (result.solution.irradiance - expected_.solution.irradiance).abs().eval();
    EXPECT_TRUE((off <= 1e-12 * exitance).all()) << what << ": " << off.maxCoeff();
  }
}

TEST_P(AllLightLaws, TheOrderOfFacesAndVerticesChangesNoBit) {
  const SolveResult result = solved(test::turned_round(scene_));
  ASSERT_TRUE(result.elements.corners == expected_.elements.corners);
  EXPECT_TRUE(result.elements.points == expected_.elements.points);
  EXPECT_TRUE((result.solution.irradiance == expected_.solution.irradiance).all());
  EXPECT_EQ(result.relative_error, expected_.relative_error);
}

TEST_P(ReflectedLaws, ExitanceScalesAllLight) {
  for (const double factor : {1e-150, 1e150}) {
    Scene scene = scene_;
    for (Material& material : scene.materials) material.exitance *= factor;
    std::vector<Rgb> got = powers(solved(scene), scene_);
    for (Rgb& power : got) power /= factor;
    expect_near(powers(expected_, scene_), got, std::to_string(std::log10(factor)));
  }
}

TEST_P(AllLightLaws, WhatIsFarAwayOrTinyChangesNothing) {
  double exitance = 0;
  for (const Material& material : scene_.materials)
    exitance = std::max(exitance, material.exitance.maxCoeff());
  for (const auto& [distance, extent] :
       {std::pair(1e3, 1e2), std::pair(1e6, 1e5), std::pair(10., 1e-9)}) {
    const std::string what = "a triangle " + std::to_string(distance) + " away";
    const SolveResult result = solved(test::with_black_triangle(scene_, distance, extent));
    if (distance == 1e3 && expected_.reflected.elements > 0 && !expected_.reflected.is_exact)
      // Rays that pass an edge may meet others in single precision of the larger scene.
      expect_near(powers(expected_, scene_), powers(result, scene_), what);
    else
      EXPECT_LE(largest_difference(expected_, result), 1e-12 * exitance) << what;
  }
}

double to_single(double x) { return static_cast<float>(x); }

template <int digits>
double to_digits(double x) {
  return std::stod(fmt::format("{:.{}g}", x, digits));
}

/// Corners that meet, and those of a face, are off a plane by what digits of a file come to: light
/// is the same, and takes not many times the elements.
TEST_P(AllLightLaws, AreTheSameInFewDigits) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Scene turned = scene_;
  for (Vec3& p : turned.vertices) p = turn * p + diagonal(scene_) * Vec3(0.3, 0.2, -0.2);
  const SolveResult expected = solved(turned);
  expect_near(powers(expected_, scene_), powers(expected, scene_), "turned");
  // Bars in six digits take 4.2 times the elements.
  for (const auto& [what, round, times] :
       {std::tuple("single precision", &to_single, 4), std::tuple("six digits", &to_digits<6>, 5),
        std::tuple("five digits", &to_digits<5>, 4)}) {
    Scene rounded = turned;
    for (Vec3& p : rounded.vertices) p = p.unaryExpr(round);
    const SolveResult result = solved(rounded);
    EXPECT_LE(result.elements.count(), times * expected.elements.count()) << what;
    expect_near(powers(expected, scene_), powers(result, scene_), what);
  }
}

/// Every face has corners of its own, so that splinters and slits run along all edges.
TEST_P(AllLightLaws, AreTheSameWithCornersThatDiffer) {
  std::vector<double> offs = {1e-7};
  if (!GetParam().starts_with("random_")) offs.push_back(1e-9);
  for (const double off : offs) {
    const SolveResult result = solved(test::with_own_corners(scene_, off, 7));
    EXPECT_TRUE(result.solution.irradiance.allFinite());
    expect_near(powers(expected_, scene_), powers(result, scene_), std::to_string(std::log10(off)));
  }
}

const Vec3 axis = Vec3(0.3, -0.5, 0.8).normalized();

/// To six decimals.
void turn_and_round(Scene& scene, double angle) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  for (Vec3& p : scene.vertices)
    p = (turn * p).unaryExpr([](double x) { return std::round(x * 1e6) / 1e6; });
}

/// A table that stands on the floor, turned, whose feet decimals lift or sink.
TEST(LawsOfExactParts, WhatStandsOnAFloorNeedsNoMoreElementsInDecimals) {
  Scene scene = test::room({4, 3, 2.5}, {{{.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}}});
  const int thing = test::add_material(scene, 0.7, 0), lamp = test::add_material(scene, 0.4, 10);
  const auto add_box = [&](const Vec3& low, const Vec3& size) {
    for (const auto& face : test::box_faces(low, low + size, false))
      test::add_polygon(scene, face, thing);
  };
  for (const double x : {1.3, 2.6})
    for (const double y : {1., 1.9}) add_box({x, y, 0}, {0.06, 0.06, 0.71});
  add_box({1.2, 0.9, 0.71}, {1.5, 1.2, 0.04});
  test::add_polygon(scene, {{1.5, 1, 2.45}, {1.5, 2, 2.45}, {2.5, 2, 2.45}, {2.5, 1, 2.45}}, lamp);
  SolveOptions options;
  options.tolerance = 0.02;
  options.visibility = ReflectedVisibility::exact;
  for (const double angle : {0.7, 1.9, 2.6}) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    Scene exact = scene, rounded = scene;
    for (Vec3& p : exact.vertices) p = turn * p;
    turn_and_round(rounded, angle);
    const SolveResult expected = solve(exact, options), result = solve(rounded, options);
    EXPECT_EQ(result.not_reached, "");
    EXPECT_LE(result.reflected.elements, 1.2 * expected.reflected.elements) << angle;
    EXPECT_LT(result.reflected.row_error, 0.5) << angle;
  }
}

/// Two boxes side by side in a corner: what is buried between them, their backs and the walls sees
/// anything, in decimals.
Scene boxes_in_a_corner() {
  Scene scene = test::room({4, 3, 2.5}, {{{.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.3, 0}, {.5, 0}}});
  const int thing = test::add_material(scene, 0.7, 0), lamp = test::add_material(scene, 0.4, 10);
  for (const auto& [low, high] : {std::pair(Vec3(0, 0, 0), Vec3(0.8, 0.5, 1.1)),
                                  std::pair(Vec3(0.8, 0, 0), Vec3(1.5, 0.5, 0.7))})
    for (const auto& face : test::box_faces(low, high, false))
      test::add_polygon(scene, face, thing);
  test::add_polygon(scene, {{1.5, 1, 2.5}, {1.5, 2, 2.5}, {2.5, 2, 2.5}, {2.5, 1, 2.5}}, lamp);
  return scene;
}

TEST(LawsOfExactParts, GiveWayToRaysWhereMoreElementsDoNotHelp) {
  Scene scene = boxes_in_a_corner();
  const SolveOptions options;
  const SolveResult expected = solve(scene, options);
  turn_and_round(scene, 2.6);
  const SolveResult result = solve(scene, options);
  EXPECT_EQ(result.not_reached, "");
  EXPECT_TRUE(expected.reflected.is_exact);
  EXPECT_FALSE(result.reflected.is_exact);
  expect_near(powers(expected, scene), powers(result, scene), "in decimals");

  std::stop_source stop;
  const Progress progress{stop.get_token(), [&](std::string_view stage, double) {
                            if (stage == "rays of reflected light") stop.request_stop();
                          }};
  const SolveResult stopped = solve(scene, options, progress);
  EXPECT_TRUE(stopped.interrupted);
  // A third and more of the light is reflected.
  EXPECT_LT(stopped.reflected.error, 0.1) << "what either way came to is kept";
  expect_near(powers(expected, scene), powers(stopped, scene), "in decimals, stopped", 0.1);
}

/// Few scenes are large enough for rays of their own accord.
TEST(LawsOfRays, WhatIsFarAwayOrTinyChangesNothing) {
  SolveOptions options;
  options.tolerance = 0.03;
  options.visibility = ReflectedVisibility::sampled;
  for (const char* name : {"cornell_box", "l_room", "table_and_chairs"}) {
    const Scene scene = test::named_scene(name);
    const SolveResult expected = solve(scene, options);
    EXPECT_GT(expected.reflected.rays, 0) << name;
    for (const auto& [distance, extent] :
         {std::pair(1e4, 1e3), std::pair(1e9, 1e8), std::pair(10., 1e-9)}) {
      const SolveResult result = solve(test::with_black_triangle(scene, distance, extent), options);
      EXPECT_LE(largest_difference(expected, result), 1e-12)
          << name << ", a triangle " << distance << " away";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReflectedLaws, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return scene.param; });
INSTANTIATE_TEST_SUITE_P(Scenes, AllLightLaws, testing::ValuesIn(more_scenes()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace halfshade
