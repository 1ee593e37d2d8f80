#include "solver/reflected/reflected_light.h"

#include "meshing/core/error.h"
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
#include <cmath>

namespace halfshade {
namespace {

DirectIrradiance exact(const SoundScene& scene, const DirectLightIndex& index) {
  return [&](int surface, const Vec3& p) {
    return index.irradiance({p, scene.surfaces[at(surface)].frame.normal}).irradiance;
  };
}

ReflectedOptions within(double tolerance) {
  ReflectedOptions options;
  options.tolerance = tolerance;
  return options;
}

/// ∫ G, one channel.
double integral(const ReflectedLight& light) {
  double sum = 0;
  for (int e = 0; e < light.elements().count(); ++e)
    sum += light.elements().area[at(e)] * light.field().of(e)(0, 0);
  return sum;
}

void expect_furnace(const SoundScene& scene, double tolerance) {
  ReflectedOptions options = within(0.02);
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
  expect_furnace(make_sound(furnace(test::room({1, 1, 1}, {}), 1)), 1e-12);
  expect_furnace(make_sound(furnace(test::l_room(true), 2)), 1e-12);
}

TEST(ReflectedLight, ATwoSidedSheetInAFurnaceIsWhiteOnBothSides) {
  Scene scene = test::room({1, 1, 1}, {});
  const int sheet = test::add_material(scene, 0.5, 0.5);
  scene.materials[at(sheet)].two_sided = true;
  test::add_polygon(scene, {{.2, .2, .5}, {.7, .2, .4}, {.7, .7, .4}, {.2, .7, .5}}, sheet);
  expect_furnace(make_sound(furnace(scene, 4)), 1e-12);
}

TEST(ReflectedLight, TheMeanInAClosedRoomIsThatOfTheBalance) {
  for (const double rho : {0.5, 0.8, 1 - 1e-12}) {
    const SoundScene scene = make_sound(test::lit_cube({rho, rho, rho, rho, rho, rho}));
    const DirectLightIndex index(scene);
    const ReflectedLight light = reflected_light(scene, exact(scene, index), within(0.03));
    EXPECT_EQ(light.report().closed_systems, 1);
    const double expected = rho / (1 - rho);  // the power is 1
    EXPECT_NEAR(integral(light) / expected, 1, 1e-9) << rho;
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
  const auto solved = [&](int threads) {
    return tbb::task_arena(threads).execute(
        [&] { return reflected_light(scene, exact(scene, index), within(0.04)); });
  };
  const ReflectedLight one = solved(1), two = solved(2);
  EXPECT_TRUE((one.field().coefficients == two.field().coefficients).all());
  EXPECT_EQ(one.report().error, two.report().error);
  EXPECT_EQ(one.report().rays, two.report().rays);
}

TEST(ReflectedLight, WhatIsThereWhenStoppedIsKept) {
  const SoundScene scene = make_sound(test::lit_cube({.5, .5, .5, .5, .5, .5}));
  const DirectLightIndex index(scene);
  std::stop_source stop;
  Progress progress{stop.get_token(), [&](std::string_view stage, double) {
                      if (stage == "final rays of reflected light") stop.request_stop();
                    }};
  const ReflectedLight coarse = reflected_light(scene, exact(scene, index), within(0.01), progress);
  EXPECT_EQ(coarse.report().end, ReflectedEnd::interrupted);
  EXPECT_NEAR(integral(coarse), 1, 1e-3);
  const ReflectedLight nothing =
      reflected_light(scene, exact(scene, index), within(0.01), progress);
  EXPECT_EQ(nothing.report().end, ReflectedEnd::interrupted);
  EXPECT_EQ(integral(nothing), 0);
}

struct Case {
  const char* name;
  Scene scene;
  double tolerance;
  int bounces;  ///< after which next to nothing is left
};

/// Within the claimed error and the noise of random walks.
void expect_right(const Case& c) {
  SCOPED_TRACE(c.name);
  const SoundScene scene = make_sound(c.scene);
  const test::PathTracer tracer(scene);
  const ReflectedLight light =
      reflected_light(scene, exact(scene, tracer.direct()), within(c.tolerance));
  EXPECT_EQ(light.report().end, ReflectedEnd::accurate);
  EXPECT_LE(light.report().error, c.tolerance);
  test::Random random(11);
  double excess = 0, deviation = 0, all = 0, bias = 0, bias_variance = 0, mean = 0;
  double gathered = 0;
  for (const auto& [surface, point] : test::spread_points(light.elements(), 200, random)) {
    const Rgb direct = tracer.direct().irradiance(point).irradiance;
    const test::TracedLight traced = tracer.reflected(point, 16, c.bounces, random);
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
  EXPECT_LE(std::abs(bias), 3 * std::sqrt(3 * bias_variance) + 0.3 * c.tolerance * mean);
  const double found = light.report().mean_square_total / (all / 200);
  EXPECT_NEAR(found, 1, 0.4);
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
