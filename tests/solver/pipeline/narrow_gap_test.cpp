#include "meshing/repair/repair.h"
#include "solver/pipeline/solve.h"
#include "solver/reference/reference_light.h"
#include "tests/support/mean_irradiance.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

// Two plates of nearly white material close to each other: light is reflected some hundred times
// before it gets out, within a few times the gap of the border.

namespace halfshade {
namespace {

Scene plates(double gap, double rho) {
  Scene scene;
  const int light = test::add_material(scene, rho, 1), dark = test::add_material(scene, rho, 0);
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, light);
  test::add_polygon(scene, {{0, 1, gap}, {1, 1, gap}, {1, 0, gap}, {0, 0, gap}}, dark);
  return scene;
}

struct Mean {
  double value, deviation;
};

/// Mean irradiance of both plates by walks: from a point of one the other is hit a distance gap
/// tan θ away, sin² θ uniform.
Mean walked(double gap, double rho, int walks) {
  test::Random random(1);
  double sum = 0, squares = 0;
  for (int i = 0; i < walks; ++i) {
    Vec2 place(random(0, 1), random(0, 1));
    double weight = 1, hits = 0;
    for (;;) {
      const double u = random(0, 1), length = gap * std::sqrt(u / (1 - u));
      const double angle = random(0, 2 * M_PI);
      place += length * Vec2(std::cos(angle), std::sin(angle));
      if (place.minCoeff() < 0 || place.maxCoeff() > 1) break;
      hits += weight;
      weight *= rho;
    }
    sum += hits;
    squares += hits * hits;
  }
  const double mean = sum / walks;
  return {mean / 2, std::sqrt((squares / walks - mean * mean) / walks) / 2};
}

SolveResult solved(double gap, double rho) { return solve(plates(gap, rho), SolveOptions{}); }

TEST(NarrowGap, IsSolvedAsExactlyAsClaimed) {
  for (const auto& [gap, rho] : {std::pair(0.1, 0.9), {0.03, 0.99}}) {
    const SolveResult result = solved(gap, rho);
    const Mean mean = walked(gap, rho, 40000);
    EXPECT_LE(result.relative_error, 0.01);
    EXPECT_TRUE(result.not_reached.empty());
    EXPECT_NEAR(test::mean_irradiance(result)[0], mean.value,
                3 * mean.deviation + result.relative_error * mean.value)
        << gap;
  }
}

TEST(NarrowGap, TooNarrowToSeeWhatGetsLostIsTold) {
  const SolveResult result = solved(1e-3, 0.999);
  const Mean mean = walked(1e-3, 0.999, 400);
  EXPECT_EQ(result.reflected.end, ReflectedEnd::elements);
  EXPECT_FALSE(result.not_reached.empty());
  EXPECT_GT(result.relative_error, 0.01);
  EXPECT_NEAR(test::mean_irradiance(result)[0], mean.value,
              3 * mean.deviation + result.relative_error * mean.value);
}

/// Such plates, a tenth as large, in a closed room with a lamp.
Scene plates_in_a_room(double gap, double rho) {
  Scene scene;
  const int wall = test::add_material(scene, 0.5, 0), lamp = test::add_material(scene, 0, 10);
  const int light = test::add_material(scene, rho, 1), dark = test::add_material(scene, rho, 0);
  for (const auto& face : test::box_faces({-2, -2, -1}, {2, 2, 2}, true))
    test::add_polygon(scene, face, wall);
  test::add_polygon(scene, {{-1, -1, 1.9}, {-1, -0.5, 1.9}, {-0.5, -0.5, 1.9}, {-0.5, -1, 1.9}},
                    lamp);
  test::add_polygon(scene, {{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.3, 0}, {0, 0.3, 0}}, light);
  test::add_polygon(scene, {{0, 0.3, gap}, {0.3, 0.3, gap}, {0.3, 0, gap}, {0, 0, gap}}, dark);
  return scene;
}

/// What all light is off, at least, as a share of it: what the plates' means are off.
Mean error_of_plates(const SolveResult& result, int samples) {
  double error = 0, variance = 0, all = 0;
  std::vector<ReferenceTriangle> triangles;
  std::vector<int> elements;
  for (int e = 0; e < result.elements.count(); ++e) {
    const double area = result.elements.area[at(e)];
    all += area * result.solution.irradiance.row(e).square().sum();
    if (area == 0 || result.scene.materials[at(result.elements.material[at(e)])].rho[0] < 0.6)
      continue;
    triangles.push_back(result.elements.triangle(e));
    elements.push_back(e);
  }
  ReferenceOptions options;
  options.samples = samples / static_cast<int>(triangles.size());
  const ReferenceLight reference = reference_means(result.scene, triangles, options);
  for (const double low : {-1., 1.}) {  // the side that they look to
    Rgb missing = Rgb::Zero(), deviations = missing;
    double area = 0;
    for (std::size_t k = 0; k < elements.size(); ++k) {
      const int e = elements[k];
      const int surface = result.elements.surface[at(e)];
      if (result.scene.surfaces[at(surface)].frame.normal.z() * low < 0) continue;
      const double part = result.elements.area[at(e)];
      area += part;
      missing += part * (reference.values[k].total - result.solution.irradiance.row(e).transpose());
      deviations += (part * reference.standard_errors[k].total).square();
    }
    error += missing.square().sum() / area;
    variance += deviations.sum() / area;
  }
  return {std::sqrt(error / all), std::sqrt(variance / all)};
}

TEST(NarrowGap, LosesInARoomWhatIsClaimed) {
  for (const auto& [gap, rho] : {std::pair(1e-3, 0.99), {3e-4, 0.99}})
    for (const ReflectedVisibility visibility :
         {ReflectedVisibility::exact, ReflectedVisibility::sampled}) {
      SolveOptions options;
      options.tolerance = 0.05;
      options.visibility = visibility;
      const SolveResult result = solve(plates_in_a_room(gap, rho), options);
      const Mean error = error_of_plates(result, 60000);
      EXPECT_LE(error.value, result.relative_error + 3 * error.deviation) << gap << ", " << rho;
      if (visibility == ReflectedVisibility::exact) {
        EXPECT_LT(result.relative_error, 0.1) << gap << ", " << rho;
      }
    }
}

/// Nine boxes a little above the floor of a room, and a lamp a little below its ceiling.
Scene boxes_above_a_floor() {
  Scene scene;
  const int wall = test::add_material(scene, 0.75, 0), lamp = test::add_material(scene, 0, 10);
  const int grey = test::add_material(scene, 0.45, 0);
  for (const auto& face : test::box_faces({0, 0, 0}, {2, 2, 2}, true))
    test::add_polygon(scene, face, wall);
  test::add_polygon(scene, {{.7, .7, 1.99}, {.7, 1.3, 1.99}, {1.3, 1.3, 1.99}, {1.3, .7, 1.99}},
                    lamp);
  for (const double x : {0.13, 0.8, 1.47})
    for (const double y : {0.13, 0.8, 1.47})
      for (const auto& face : test::box_faces({x, y, 0.001}, {x + 0.4, y + 0.4, 0.4}, false))
        test::add_polygon(scene, face, grey);
  return scene;
}

// To see all of what gets lost would have taken thousands of elements: it was given up with 8.6 %
// before any were tried.
TEST(NarrowGap, ManyAreLookedIntoByRaysAsLongAsThatHelps) {
  SolveOptions options;
  options.tolerance = 0.02;
  options.visibility = ReflectedVisibility::sampled;
  const SolveResult result = solve(boxes_above_a_floor(), options);
  EXPECT_TRUE(result.not_reached.empty()) << result.not_reached;
  EXPECT_LE(result.relative_error, options.tolerance);
  std::vector<ReferenceTriangle> triangles;
  for (int e = 0; e < result.elements.count(); ++e)
    triangles.push_back(result.elements.triangle(e));
  const ReferenceLight light = reference_means(result.scene, triangles, {.samples = 64});
  double excess = 0, variance = 0, all = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    const double area = result.elements.area[at(e)];
    const Rgb mean = result.solution.irradiance.row(e).transpose();
    const auto& [value, error] = std::pair(light.values[at(e)], light.standard_errors[at(e)]);
    const double noise = area * error.total.square().sum();
    excess += area * (mean - value.total).square().sum() - noise;
    variance += 2 * noise * noise;
    all += area * mean.square().sum();
  }
  EXPECT_LE(excess, std::pow(result.relative_error, 2) * all + 3 * std::sqrt(variance));
}

/// A lamp hung close below the ceiling of a white room; what gets between them meets its back.
Scene lamp_below_a_ceiling(double gap, double rho) {
  Scene scene;
  const int wall = test::add_material(scene, rho, 0), lamp = test::add_material(scene, rho, 4);
  for (const auto& face : test::box_faces({0, 0, 0}, {3, 2, 4}, true))
    test::add_polygon(scene, face, wall);
  const double z = 4 - gap;
  test::add_polygon(scene, {{1, 1, z}, {1, 1.5, z}, {1.5, 1.5, z}, {1.5, 1, z}}, lamp);
  return scene;
}

/// Light changes within some gaps' width of the lamp's border, and what gets in above it is lost,
/// which nodes of elements hardly ever see: the room of .995 was 1.7 % too bright, that of .999 by
/// 6.6 %, where .7 % was claimed. Of what arrives on the ceiling above the lamp, elements of the
/// result may show nothing if no sample falls there: .5 % of the mean at a gap of .003. Means of
/// the walls by 2 million random walks of a program that shares no code with this one (for .01,
/// walks from the walls find the same), which are sure to .025, .08 and .013 %.
TEST(NarrowGap, WhatGetsLostBehindALampIsAsMuchAsIsClaimed) {
  struct Case {
    double gap, rho, walked;
  };
  for (const auto& [gap, rho, walked] :
       {Case{0.01, 0.995, 3.61913}, {0.01, 0.999, 14.8606}, {0.003, 0.99, 1.89603}}) {
    SolveOptions options;
    options.tolerance = 0.01;
    const SolveResult result = solve(lamp_below_a_ceiling(gap, rho), options);
    EXPECT_TRUE(result.not_reached.empty());
    EXPECT_LE(result.relative_error, 0.01);
    double sum = 0, area = 0;
    for (int e = 0; e < result.elements.count(); ++e) {
      if (result.scene.materials[at(result.elements.material[at(e)])].exitance[0] > 0) continue;
      area += result.elements.area[at(e)];
      sum += result.elements.area[at(e)] * result.solution.irradiance(e, 0);
    }
    EXPECT_NEAR(area, 52, 1e-9);
    EXPECT_NEAR(sum / area, walked, 0.4 * result.relative_error * walked) << gap << ", " << rho;
  }
}

TEST(NarrowGap, ElementsOfTheMatrixThatAreTooLongTellSo) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 600;
  EXPECT_FALSE(solve(plates(1e-3, 0.999), options).not_reached.empty());
  EXPECT_TRUE(solve(plates(1e-3, 0.5), options).not_reached.empty()) << "hardly any comes back";
  const SolveResult wide = solve(plates(0.1, 0.99), options);
  const Mean mean = walked(0.1, 0.99, 40000);
  EXPECT_TRUE(wide.not_reached.empty());
  EXPECT_NEAR(test::mean_irradiance(wide)[0], mean.value, 0.05 * mean.value);
}

TEST(NarrowGap, RaysThatNeverSeeItTellSo) {
  SolveOptions options;
  options.visibility = ReflectedVisibility::sampled;
  const SolveResult result = solve(plates(1e-4, 0.99999), options);
  EXPECT_EQ(result.reflected.end, ReflectedEnd::rays);
  EXPECT_GT(result.relative_error, 0.1);
}

TEST(NarrowGap, HidesDarkPartsOfACeilingWithoutDarkeningTheRest) {
  // What is dark of the ceiling, 1 cm behind the lamp's back, is not seen past it: triangles that
  // stood for smaller ones there made all light .96 % too weak. Rays are right to .05 % by random
  // walks of a separate program.
  Scene scene =
      test::room({6, 4, 2.5}, {{{0.87, 0}, {0.87, 0}, {0.87, 0}, {0.87, 0}, {0.87, 0}, {0.87, 0}}});
  const double z = 2.49;
  test::add_polygon(scene, {{0.2, 1, z}, {0.2, 1.4, z}, {0.6, 1.4, z}, {0.6, 1, z}},
                    test::add_material(scene, 0, 50));
  SolveOptions options;
  options.tolerance = 0.01;
  const auto mean = [&](ReflectedVisibility visibility) {
    options.visibility = visibility;
    return test::mean_irradiance(solve(scene, options))[0];
  };
  EXPECT_NEAR(mean(ReflectedVisibility::exact) / mean(ReflectedVisibility::sampled), 1, 0.003);
}

}  // namespace
}  // namespace halfshade
