#include "solver/reflected/reflected_light.h"

#include "meshing/core/error.h"
#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/cornell.h"
#include "tests/support/discontinuity_scenes.h"
#include "tests/support/element_points.h"
#include "tests/support/expect_error.h"
#include "tests/support/furniture.h"
#include "tests/support/path_tracer.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace halfshade {
namespace {

DirectIrradiance exact(const SoundScene& scene, const DirectLightIndex& index) {
  return [&](int surface, const Vec3& p) {
    return index.irradiance({p, scene.surfaces[at(surface)].frame.normal}).irradiance;
  };
}

constexpr std::array both = {ReflectedVisibility::exact, ReflectedVisibility::sampled};

ReflectedOptions within(double tolerance,
                        ReflectedVisibility visibility = ReflectedVisibility::automatic) {
  ReflectedOptions options;
  options.tolerance = tolerance;
  options.visibility = visibility;
  return options;
}

/// ∫ G, one channel.
double integral(const ReflectedLight& light) {
  double sum = 0;
  for (int e = 0; e < light.elements().count(); ++e)
    sum += light.elements().area[at(e)] * light.field().of(e)(0, 0);
  return sum;
}

void expect_furnace(const SoundScene& scene, double tolerance, ReflectedVisibility visibility) {
  ReflectedOptions options = within(0.02, visibility);
  options.through_operator = true;
  const ReflectedLight light = reflected_light(scene, {}, options);
  EXPECT_EQ(light.report().end, ReflectedEnd::accurate);
  test::Random random(3);
  for (const auto& [surface, point] : test::spread_points(light.elements(), 100, random)) {
    const Material& m = scene.materials[at(scene.surfaces[at(surface)].material)];
    const Rgb radiosity = m.exitance + m.rho * light.irradiance(surface, point.position);
    EXPECT_LT((radiosity - 1).abs().maxCoeff(), tolerance);
    EXPECT_LT((light.gather(point, 100) - 1).abs().maxCoeff(), 1e-6);
  }
}

Scene furnace(Scene scene, unsigned seed) {
  test::Random random(seed);
  for (Material& m : scene.materials) {
    for (double& rho : m.rho) rho = random(0, 1);
    m.exitance = 1 - m.rho;
  }
  return scene;
}

TEST(ReflectedLight, FurnacesAreWhite) {
  for (const ReflectedVisibility v : both) {
    expect_furnace(make_sound(furnace(test::room({1, 1, 1}, {}), 1)), 1e-12, v);
    expect_furnace(make_sound(furnace(test::l_room(true), 2)), 1e-12, v);
  }
}

TEST(ReflectedLight, ATwoSidedSheetInAFurnaceIsWhiteOnBothSides) {
  Scene scene = test::room({1, 1, 1}, {});
  const int sheet = test::add_material(scene, 0.5, 0.5);
  scene.materials[at(sheet)].two_sided = true;
  test::add_polygon(scene, {{.2, .2, .5}, {.7, .2, .4}, {.7, .7, .4}, {.2, .7, .5}}, sheet);
  for (const ReflectedVisibility v : both) expect_furnace(make_sound(furnace(scene, 4)), 1e-12, v);
}

TEST(ReflectedLight, TheMeanInAClosedRoomIsThatOfTheBalance) {
  for (const double rho : {0.5, 0.8, 1 - 1e-12}) {
    const SoundScene scene = make_sound(test::lit_cube({rho, rho, rho, rho, rho, rho}));
    const DirectLightIndex index(scene);
    const double expected = rho / (1 - rho);  // the power is 1
    for (const ReflectedVisibility v : both) {
      const ReflectedLight light = reflected_light(scene, exact(scene, index), within(0.03, v));
      EXPECT_EQ(light.report().closed_systems, 1);
      EXPECT_NEAR(integral(light) / expected, 1, 1e-9) << rho;
    }
  }
}

TEST(ReflectedLight, MayBeOffByWhatOtherErrorsLeave) {
  const SoundScene scene = make_sound(test::lit_cube({.5, .5, .5, .5, .5, .5}));
  const DirectLightIndex index(scene);
  for (const ReflectedVisibility v : both) {
    ReflectedOptions options = within(0.04, v);
    const ReflectedReport alone = reflected_light(scene, exact(scene, index), options).report();
    const double norm = std::sqrt(6 * alone.mean_square_total);
    options.other_error = 0.9 * options.tolerance * norm;
    const ReflectedReport beside = reflected_light(scene, exact(scene, index), options).report();
    EXPECT_EQ(beside.end, ReflectedEnd::accurate);
    EXPECT_LE(std::hypot(beside.error, 0.9 * options.tolerance), 1.001 * options.tolerance);
    options.other_error = 2 * options.tolerance * norm;
    const ReflectedReport rest = reflected_light(scene, exact(scene, index), options).report();
    EXPECT_EQ(rest.end, ReflectedEnd::accurate);
    EXPECT_LE(rest.error, 0.2 * options.tolerance);
    if (v == ReflectedVisibility::sampled) {
      EXPECT_GT(rest.rays, alone.rays);
    }
  }
}

TEST(ReflectedLight, OneBounceIsOneApplication) {
  const SoundScene scene = make_sound(test::lit_cube({.5, .5, .5, .5, .5, .5}));
  const DirectLightIndex index(scene);
  ReflectedOptions options = within(0.03);
  options.bounces = 1;
  EXPECT_NEAR(integral(reflected_light(scene, exact(scene, index), options)), 0.5, 1e-9);
  options.bounces = 3;
  EXPECT_NEAR(integral(reflected_light(scene, exact(scene, index), options)), 0.875, 0.005);
  options.bounces = 0;
  const ReflectedLight none = reflected_light(scene, exact(scene, index), options);
  EXPECT_EQ(none.report().end, ReflectedEnd::nothing);
  EXPECT_EQ(none.report().rays, 0);
  EXPECT_EQ(integral(none), 0);
}

TEST(ReflectedLight, RoomsThatDoNotSeeEachOtherAreSolvedApart) {
  Scene scene = test::room({1, 1, 1}, {});
  for (const auto& face : test::box_faces({2, 0, 0}, {3, 1, 1}, true))
    test::add_polygon(scene, face, test::add_material(scene, 0, 0));
  for (std::size_t f = 0; f < 12; ++f) {
    scene.materials[f].rho.setConstant(f < 6 ? 0.5 : 1 - 1e-9);
    scene.materials[f].exitance.setConstant(f < 6 ? 1e-30 : 1e30);
  }
  const SoundScene sound = make_sound(scene);
  ReflectedOptions options = within(0.02);
  options.through_operator = true;
  const ReflectedLight light = reflected_light(sound, {}, options);
  EXPECT_EQ(light.report().closed_systems, 2);
  for (int s = 0; s < 12; ++s) {
    const double expected = s < 6 ? 2e-30 : 1e30 / 1e-9;
    const Vec3 p = sound.surfaces[at(s)].frame.origin;
    EXPECT_NEAR(light.irradiance(s, p)[0] / expected, 1, 1e-6) << s;
  }
}

TEST(ReflectedLight, RefusesAClosedSpaceThatReflectsEverything) {
  const SoundScene scene = make_sound(test::lit_cube({1, 1, 1, 1, 1, 1}));
  const DirectLightIndex index(scene);
  test::expect_error([&] { reflected_light(scene, exact(scene, index)); }, ErrorCode::invalid_input,
                     {"reflects everything"});
}

TEST(ReflectedLight, BlackRoomsCostNothing) {
  const SoundScene scene = make_sound(test::lit_cube({0, 0, 0, 0, 0, 0}));
  const DirectLightIndex index(scene);
  const ReflectedLight light = reflected_light(scene, exact(scene, index));
  EXPECT_EQ(light.report().end, ReflectedEnd::nothing);
  EXPECT_EQ(light.report().rays, 0);
  EXPECT_TRUE((light.irradiance(0, scene.surfaces[0].frame.origin) == 0).all());
}

TEST(ReflectedLight, BytesDoNotDependOnThreads) {
  const SoundScene scene = make_sound(test::cornell_box());
  const DirectLightIndex index(scene);
  for (const ReflectedVisibility v : both) {
    const auto solved = [&](int threads) {
      return tbb::task_arena(threads).execute(
          [&] { return reflected_light(scene, exact(scene, index), within(0.04, v)); });
    };
    const ReflectedLight one = solved(1), two = solved(2);
    EXPECT_TRUE((one.field().coefficients == two.field().coefficients).all());
    EXPECT_EQ(one.report().error, two.report().error);
    EXPECT_EQ(one.report().rays, two.report().rays);
  }
}

// Of two factors gathered at one point: what rays of both miss must not be the same.
TEST(ReflectedLight, AnotherPatternOfRaysHasErrorsOfItsOwn) {
  const SoundScene scene = make_sound(test::cornell_box());
  const DirectLightIndex index(scene);
  const ReflectedLight light =
      reflected_light(scene, exact(scene, index), within(0.1, ReflectedVisibility::sampled));
  constexpr int few = 36, many = 2048;
  double square = 0, product = 0;
  test::Random random(7);
  for (const auto& [surface, point] : test::spread_points(light.elements(), 150, random)) {
    const Rgb mean = light.gather(point, many), off = light.gather(point, few) - mean;
    EXPECT_TRUE((light.gather(point, few, 0) - mean == off).all());
    square += off.square().sum();
    product += (off * (light.gather(point, few, 1) - mean)).sum();
  }
  EXPECT_GT(square, 0);
  EXPECT_LT(std::abs(product), 0.25 * square);
}

/// Stopped when a stage begins.
ReflectedLight stopped_at(const char* stage, ReflectedVisibility visibility) {
  const SoundScene scene = make_sound(test::lit_cube({.5, .5, .5, .5, .5, .5}));
  const DirectLightIndex index(scene);
  std::stop_source stop;
  const Progress progress{stop.get_token(), [&](std::string_view now, double) {
                            if (now == stage) stop.request_stop();
                          }};
  const ReflectedLight light =
      reflected_light(scene, exact(scene, index), within(0.01, visibility), progress);
  EXPECT_EQ(light.report().end, ReflectedEnd::interrupted);
  return light;
}

TEST(ReflectedLight, WhatIsThereWhenStoppedIsKept) {
  const auto kept = [](const char* stage, ReflectedVisibility visibility) {
    return integral(stopped_at(stage, visibility));
  };
  EXPECT_NEAR(kept("error of reflected light", ReflectedVisibility::sampled), 1, 1e-3);
  EXPECT_NEAR(kept("rays of reflected light", ReflectedVisibility::sampled), 1, 1e-3);
  EXPECT_NEAR(kept("error of reflected light", ReflectedVisibility::exact), 1, 1e-9);
  EXPECT_NEAR(kept("exact parts of reflected light", ReflectedVisibility::exact), 1, 1e-3);
}

TEST(ReflectedLight, ExactRowsMissByLessWhenLessIsAllowed) {
  const SoundScene scene = make_sound(test::l_room(true));
  const DirectLightIndex index(scene);
  for (const double tolerance : {1e-2, 1e-3}) {
    ReflectedOptions options = within(tolerance, ReflectedVisibility::exact);
    options.through_operator = true;
    options.max_rounds = 1;
    EXPECT_LE(reflected_light(scene, {}, options).report().row_error, 1e-2 * tolerance);
  }
}

TEST(ReflectedLight, DirectLightThroughExactPartsTakesNoSolutionOfItsOwn) {
  const SoundScene scene = make_sound(furnace(test::room({1, 1, 1}, {}), 5));
  ReflectedOptions options = within(1e-4, ReflectedVisibility::exact);
  options.through_operator = true;
  const ReflectedLight light = reflected_light(scene, {}, options);
  ASSERT_EQ(light.bounces(), 1);
  const ElementTable& elements = light.elements();
  std::vector<double> found(6, 0), expected(6, 0);
  for (int e = 0; e < elements.count(); ++e) {
    const auto [a, b, c] = elements.triangle(e);
    const int s = elements.surface[at(e)];
    for (const Vec3& p : {Vec3((a + b) / 2), Vec3((b + c) / 2), Vec3((c + a) / 2)})
      found[at(s)] += elements.area[at(e)] / 3 * light.irradiance_after(1, s, p)[0];
  }
  // F between opposite faces of a cube, in closed form.
  constexpr double opposite = 0.19982489569838746, beside = (1 - opposite) / 4;
  for (int s = 0; s < 6; ++s)
    for (int t = 0; t < 6; ++t) {
      const double facing =
          scene.surfaces[at(s)].frame.normal.dot(scene.surfaces[at(t)].frame.normal);
      const Material& m = scene.materials[at(scene.surfaces[at(t)].material)];
      if (s != t) expected[at(s)] += (facing < -0.5 ? opposite : beside) * m.exitance[0];
    }
  for (std::size_t s = 0; s < 6; ++s)
    EXPECT_NEAR(found[s], expected[s], options.tolerance * expected[s]) << s;
}

struct Case {
  const char* name;
  Scene scene;
  double tolerance;
  int bounces;  ///< after which next to nothing is left
};

struct TracedPoint {
  int surface;
  SurfacePoint point;
  Rgb direct;
  test::TracedLight traced;
};

TEST(ReflectedLight, IsComparedWithAllLightAlsoWhereHardlyAnyPointFindsTheBrightest) {
  const SoundScene scene = make_sound(test::lit_cube({.5, .5, .5, .5, .5, .5}));
  constexpr double bright = 1000, radius = 0.01, area = std::numbers::pi * radius * radius;
  const DirectIrradiance spot = [&](int surface, const Vec3& p) {
    const bool is_lit =
        surface == 0 && (p - scene.surfaces[0].frame.to_space({0.4, 0.3})).norm() < radius;
    return Rgb(Rgb::Constant(is_lit ? bright : 0));
  };
  const double direct_square = 3 * bright * bright * area;
  for (const ReflectedVisibility v : both) {
    ReflectedOptions options = within(0.05, v);
    options.direct_norm = std::sqrt(direct_square);
    const ReflectedReport report = reflected_light(scene, spot, options).report();
    // Of G² and 2 G H_d there is a thousandth of it.
    EXPECT_NEAR(6 * report.mean_square_total / direct_square, 1, 0.005);
  }
}

/// Within the claimed error and the noise of random walks.
void expect_near(const ReflectedLight& light, std::span<const TracedPoint> points,
                 double tolerance) {
  EXPECT_EQ(light.report().end, ReflectedEnd::accurate);
  EXPECT_LE(light.report().error, tolerance);
  double excess = 0, deviation = 0, all = 0, bias = 0, bias_variance = 0, mean = 0;
  double gathered = 0;
  for (const auto& [surface, point, direct, traced] : points) {
    const Rgb off = light.irradiance(surface, point.position) - traced.mean;
    const double more = (off.square() - traced.variance).sum();
    excess += more;
    deviation += more * more;
    all += (direct + traced.mean).square().sum();
    bias += off.sum();
    bias_variance += traced.variance.sum();
    mean += (direct + traced.mean).sum();
    gathered += ((light.gather(point, 1000) - traced.mean).square() - traced.variance).sum();
  }
  const double claimed = std::pow(light.report().error, 2) * all;
  EXPECT_LE(excess - 2 * std::sqrt(deviation), claimed);
  EXPECT_LE(gathered - 2 * std::sqrt(deviation), claimed);
  EXPECT_LE(std::abs(bias), 3 * std::sqrt(3 * bias_variance) + 0.3 * tolerance * mean);
  const double found =
      light.report().mean_square_total / (all / static_cast<double>(points.size()));
  EXPECT_NEAR(found, 1, 0.4);
}

void expect_right(const Case& c) {
  SCOPED_TRACE(c.name);
  const SoundScene scene = make_sound(c.scene);
  const test::PathTracer tracer(scene);
  test::Random random(11);
  std::vector<TracedPoint> points;
  const ElementTable roots = PatchMesh(scene, {}).elements();
  for (const auto& [surface, point] : test::spread_points(roots, 200, random))
    points.push_back({surface, point, tracer.direct().irradiance(point).irradiance,
                      tracer.reflected(point, 16, c.bounces, random)});
  for (const ReflectedVisibility v : both)
    expect_near(reflected_light(scene, exact(scene, tracer.direct()), within(c.tolerance, v)),
                points, c.tolerance);
}

TEST(ReflectedLight, AgreesWithRandomWalksInTheCornellBox) {
  expect_right({"Cornell box", test::cornell_box(), 0.02, 12});
}

TEST(ReflectedLight, AgreesWithRandomWalksRoundTheCorner) {
  Scene scene = test::l_room(true);
  scene.materials[7].exitance.setOnes();
  expect_right({"L-shaped room", scene, 0.02, 9});
}

TEST(ReflectedLight, AgreesWithRandomWalksAmongFurniture) {
  expect_right({"table and chairs", test::table_and_chairs_maker().scene, 0.02, 9});
}

TEST(ReflectedLight, RefusesOptionsOutOfRange) {
  const SoundScene scene = make_sound(test::lit_cube({.5, .5, .5, .5, .5, .5}));
  ReflectedOptions options;
  options.order = 4;
  test::expect_error([&] { reflected_light(scene, {}, options); }, ErrorCode::contract, {"order"});
}

}  // namespace
}  // namespace halfshade
