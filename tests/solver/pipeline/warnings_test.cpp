#include "solver/pipeline/warnings.h"

#include "solver/pipeline/plan.h"
#include "solver/pipeline/solve.h"
#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

SolveOptions coarse_options() {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 200;
  return options;
}

std::string sentence_of(const SolveResult& result, Warning::Kind kind) {
  for (const Warning& warning : result.warnings)
    if (warning.kind == kind) return warning.sentence;
  return "";
}

TEST(Warnings, NoneInARoomInOrder) {
  EXPECT_TRUE(solve(test::lit_cube({.5, .5, .5, .5, .5, .5}), coarse_options()).warnings.empty());
}

TEST(Warnings, SurfacesThatLookAwayFromEveryLight) {
  Scene scene;
  const int grey = test::add_material(scene, .5, 0), light = test::add_material(scene, 0, 1);
  for (const auto& face : test::box_faces({0, 0, 0}, {1, 1, 1}, false))
    test::add_polygon(scene, face, grey);
  test::add_polygon(scene, {{.3, .3, .5}, {.3, .6, .5}, {.6, .6, .5}, {.6, .3, .5}}, light);
  EXPECT_NE(
      sentence_of(solve(scene, coarse_options()), Warning::Kind::nothing_lit).find("--orient"),
      std::string::npos);
}

TEST(Warnings, LightThatLeavesAndGroupsInTheDark) {
  Scene scene;
  const int grey = test::add_material(scene, .5, 0), light = test::add_material(scene, 0, 1);
  scene.groups = {"lamp", "near", "turned"};
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, light);
  test::add_polygon(scene, {{0, .1, 1}, {.1, .1, 1}, {.1, 0, 1}, {0, 0, 1}}, grey);
  test::add_polygon(scene, {{.5, .5, 1}, {.6, .5, 1}, {.6, .6, 1}, {.5, .6, 1}}, grey);
  for (int f = 0; f < 3; ++f) scene.faces[at(f)].group = f;
  const SolveResult result = solve(scene, coarse_options());
  EXPECT_NE(sentence_of(result, Warning::Kind::light_escapes).find("99"), std::string::npos);
  const std::string dark = sentence_of(result, Warning::Kind::dark_groups);
  EXPECT_NE(dark.find("turned"), std::string::npos);
  EXPECT_EQ(dark.find("near"), std::string::npos);
  EXPECT_EQ(dark.find("lamp"), std::string::npos);
}

TEST(Warnings, LampsThatNothingLiesBefore) {
  // A room one of whose walls emits, and a lamp on the floor.
  const auto room = [](bool outwards) {
    Scene scene;
    const int grey = test::add_material(scene, .5, 0), light = test::add_material(scene, 0, 1);
    scene.groups = {"walls", "window", "lamp"};
    const auto walls = test::box_faces({0, 0, 0}, {1, 1, 1}, true);
    for (const auto& face : walls) test::add_polygon(scene, face, grey);
    if (outwards) std::ranges::reverse(scene.faces[2].vertices);
    scene.faces[2].material = light;
    scene.faces[2].group = 1;
    test::add_polygon(scene, {{.4, .4, .1}, {.6, .4, .1}, {.6, .6, .1}, {.4, .6, .1}}, light);
    scene.faces.back().group = 2;
    return scene;
  };
  EXPECT_TRUE(solve(room(false), coarse_options()).warnings.empty());
  const std::string sentence =
      sentence_of(solve(room(true), coarse_options()), Warning::Kind::outward_lamps);
  EXPECT_NE(sentence.find("the group window, and its light is lost"), std::string::npos)
      << sentence;
}

TEST(Warnings, WhatIsReflectedOutIsNotForSurfacesThatLookAway) {
  Scene scene;
  const int light = test::add_material(scene, 1, 1), white = test::add_material(scene, 1, 0);
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, light);
  test::add_polygon(scene, {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}}, white);
  const std::string sentence =
      sentence_of(solve(scene, coarse_options()), Warning::Kind::light_escapes);
  EXPECT_NE(sentence.find("all of the light leaves"), std::string::npos) << sentence;
  EXPECT_EQ(sentence.find("--flip"), std::string::npos) << sentence;
}

TEST(Warnings, RoomsThatLoseNearlyAllSayHowMuch) {
  // A room that absorbs next to nothing, with a lamp that hangs below its ceiling: its back does.
  const auto room = [](double absorbed) {
    Scene scene;
    const int wall = test::add_material(scene, 1 - absorbed, 0);
    const int light = test::add_material(scene, 1 - absorbed, 4);
    for (const auto& face : test::box_faces({0, 0, 0}, {3, 2, 4}, true))
      test::add_polygon(scene, face, wall);
    test::add_polygon(scene, {{1, 1, 3.9}, {1, 1.5, 3.9}, {1.5, 1.5, 3.9}, {1.5, 1, 3.9}}, light);
    return scene;
  };
  SolveOptions fields;
  fields.tolerance = 0.1;
  for (const SolveOptions& options : {coarse_options(), fields}) {
    const auto said = [&](double absorbed) {
      return sentence_of(solve(room(absorbed), options), Warning::Kind::light_escapes);
    };
    EXPECT_EQ(said(1e-3), "");
    EXPECT_NE(said(1e-6).find("99.9"), std::string::npos) << said(1e-6);
    EXPECT_EQ(said(1e-6).find("100"), std::string::npos) << said(1e-6);
    EXPECT_NE(said(1e-12).find("all but"), std::string::npos) << said(1e-12);
    SolveOptions direct = options;
    direct.radiosity.bounces = 0;
    EXPECT_EQ(sentence_of(solve(room(1e-3), direct), Warning::Kind::light_escapes), "");
  }
}

TEST(Warnings, LostLightIsPutRightByWhatFactorsAreMadeOf) {
  SolveResult room = solve(test::lit_cube({.5, .5, .5, .5, .5, .5}), coarse_options());
  room.exchange.unfinished = 1;
  const auto advice = [&room](FactorsBy by) {
    room.exchange.by = by;
    room.warnings =
        light_warnings({room.scene, room.elements, room.solution, room.exchange, room.radiosity});
    return sentence_of(room, Warning::Kind::lost_by_factors);
  };
  EXPECT_NE(advice(FactorsBy::rays).find("--rays"), std::string::npos);
  EXPECT_NE(advice(FactorsBy::hemicube).find("--hemicube"), std::string::npos);
  for (const FactorsBy by : {FactorsBy::hemicube, FactorsBy::exact}) {
    EXPECT_EQ(advice(by).find("--rays"), std::string::npos);
    EXPECT_NE(advice(by).find("--elements"), std::string::npos);
  }
}

TEST(Warnings, ARepairThatChangesTheLight) {
  Scene scene = test::lit_cube({.5, .5, .5, .5, .5, .5});
  test::add_polygon(scene, face_corners(scene, 4), test::add_material(scene, .9, 0));
  EXPECT_NE(sentence_of(solve(scene, coarse_options()), Warning::Kind::faces_changed), "");
}

TEST(Warnings, GapsThatAreShutBeforeALight) {
  for (const bool is_lit : {false, true}) {
    Scene scene = test::lit_cube({.5, .5, .5, .5, .5, .5});
    const int grey = test::add_material(scene, .5, 0), light = test::add_material(scene, 0, 1);
    const auto square = [](double z) {
      return std::vector<Vec3>{{100, 0, z}, {101, 0, z}, {101, 1, z}, {100, 1, z}};
    };
    test::add_polygon(scene, square(0), is_lit ? light : grey);
    std::vector<Vec3> above = square(1e-7);
    std::reverse(above.begin(), above.end());
    test::add_polygon(scene, above, grey);
    const std::string said =
        sentence_of(solve(scene, coarse_options()), Warning::Kind::faces_changed);
    EXPECT_EQ(said.find("a gap of 1e-07") != std::string::npos, is_lit) << said;
  }
}

TEST(Solve, AsksForAnEmitterAfterTheRepair) {
  Scene scene = test::lit_cube({.5, .5, .5, .5, .5, .5});
  scene.materials[5].exitance.setZero();
  test::add_polygon(scene, {{.1, .1, .5}, {.2, .1, .5}, {.3, .1, .5}},
                    test::add_material(scene, 0, 1));
  test::expect_error([&] { solve(scene, coarse_options()); }, ErrorCode::invalid_input,
                     {"light", "left"});
}

TEST(Solve, RefusesLightThatNumbersDoNotHold) {
  for (const double exitance : {1e300, 1e-300}) {
    Scene scene = test::lit_cube({.5, .5, .5, .5, .5, .5});
    scene.materials[5].exitance = Rgb::Constant(exitance);
    test::expect_error([&] { solve(scene, coarse_options()); }, ErrorCode::invalid_input,
                       {"emits"});
  }
}

TEST(Solve, ScalesWithTheLight) {
  Scene scene = test::lit_cube({.5, .3, .7, .5, .9, .2});
  const SolveResult one = solve(scene, coarse_options());
  for (const int exponent : {-500, 500}) {
    scene.materials[5].exitance = Rgb::Constant(std::ldexp(1., exponent));
    const SolveResult result = solve(scene, coarse_options());
    EXPECT_LE((result.solution.radiosity * std::ldexp(1., -exponent) - one.solution.radiosity)
                  .abs()
                  .maxCoeff(),
              1e-12);
    EXPECT_NEAR(result.relative_error, one.relative_error, 1e-9);
  }
}

TEST(Solve, ARoomThatAbsorbsNextToNothing) {
  const double rho = 1 - 1e-12;
  const SolveResult result =
      solve(test::lit_cube({rho, rho, rho, rho, rho, rho}), coarse_options());
  // Φ/(A (1 − ρ)) everywhere, but for some W/m².
  const double expected = 1 / (6 * (1 - rho));
  EXPECT_LE((result.solution.irradiance / expected - 1).abs().maxCoeff(), 1e-9);
  test::expect_error(
      [&] {
        solve(test::lit_cube({1, 1, 1, 1, 1, 1}), coarse_options());
      },
      ErrorCode::invalid_input, {"group all", "reflectance"});
}

TEST(Solve, RoomsSideBySideAreSystemsOfTheirOwn) {
  Scene scene = test::lit_cube({.7, .7, .7, .7, .7, .7});
  scene.materials[5].exitance = Rgb::Constant(1e-30);
  const int bright = test::add_material(scene, .7, 1e30);
  const auto faces = test::box_faces({1, 0, 0}, {2, 1, 1}, true);  // they share a wall
  for (std::size_t f = 0; f < 6; ++f) test::add_polygon(scene, faces[f], f == 5 ? bright : 0);
  const SolveResult result = solve(scene, coarse_options());
  EXPECT_EQ(result.radiosity.systems, 2);
  Eigen::Array2d power = Eigen::Array2d::Zero();
  for (int e = 0; e < result.elements.count(); ++e)
    power[result.elements.face[at(e)] < 6 ? 0 : 1] +=
        result.elements.area[at(e)] * result.solution.irradiance(e, 0);
  // The mean irradiance is Φ/(A (1 − ρ)).
  EXPECT_NEAR(power[0] * 1e30, 1 / .3, 1e-9);
  EXPECT_NEAR(power[1] * 1e-30, 1 / .3, 1e-9);
}

TEST(Solve, PlatesWithANarrowGapLoseLight) {
  for (const double rho : {.999, 1.}) {
    Scene scene;
    const int light = test::add_material(scene, rho, 1), dark = test::add_material(scene, rho, 0);
    test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, light);
    test::add_polygon(scene, {{0, 1, 1e-3}, {1, 1, 1e-3}, {1, 0, 1e-3}, {0, 0, 1e-3}}, dark);
    const SolveResult result = solve(scene, coarse_options());
    EXPECT_FALSE(result.exchange.closed);
    // 1 − F of parallel unit squares at a distance of 1e-3, by the closed form.
    EXPECT_NEAR(result.exchange.escaping_fraction, 1.99437e-3, 1e-6);
    const ChannelReport& channel = result.radiosity.channel[0];
    EXPECT_GT(channel.escaped_power, 0.1);
    EXPECT_LE(channel.balance, 1e-6);
    if (rho == 1) {
      EXPECT_NEAR(channel.escaped_power, 1, 1e-6);
    }
  }
}

TEST(Warnings, CurvesThatAreNotLookedFor) {
  DiscontinuityReport report;
  EXPECT_TRUE(search_warnings(report, 0.05).empty());
  report.most_work = affordable_work(0.05);
  report.left_out[3] = 20 * report.most_work;
  const std::vector<Warning> warnings = search_warnings(report, 0.05);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_STREQ(name_of(warnings[0].kind), "curves_left_out");
  for (const char* part : {"kind eee", "20 times", "--tolerance 0", "--events"})
    EXPECT_NE(warnings[0].sentence.find(part), std::string::npos) << warnings[0].sentence;
}

TEST(Warnings, MeshesThatAreNotAsAskedFor) {
  const SoundScene scene;
  EXPECT_TRUE(mesh_warnings({scene, 5, 100, 100, 0.01, 0.01}).empty());
  EXPECT_TRUE(mesh_warnings({scene, 5, 500, 0, 0.01, 0.01}).empty()) << "a length was asked for";
  EXPECT_EQ(mesh_warnings({scene, 5, 101, 100, 0.01, 0.01}).size(), 1u);
  const std::vector<Warning> warnings = mesh_warnings({scene, 5, 500, 100, 0.64, 0.01});
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].kind, Warning::Kind::elements_exceeded);
  EXPECT_NE(warnings[0].sentence.find("500 elements, more than the 100"), std::string::npos);
  EXPECT_EQ(warnings[1].kind, Warning::Kind::tolerance_raised);
  EXPECT_NE(warnings[1].sentence.find("0.64"), std::string::npos);
  EXPECT_NE(mesh_warnings({scene, 0, 100, 100, 9, 0.01})[0].sentence.find("no curves"),
            std::string::npos);
}

TEST(Warnings, MorePowerThanThereIs) {
  RadiosityReport report;
  report.channels = 2;
  report.channel[0].emitted_power = report.channel[1].emitted_power = 2;
  report.channel[0].absorbed_power = 1;
  report.channel[1].absorbed_power = 2.02;
  EXPECT_TRUE(power_warnings(report, 0.011).empty());
  report.channel[2].absorbed_power = 9;  // of a channel that is not used
  const std::vector<Warning> warnings = power_warnings(report, 0.009);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_STREQ(name_of(warnings[0].kind), "power_gained");
  EXPECT_NE(warnings[0].sentence.find("absorb 1 % more"), std::string::npos)
      << warnings[0].sentence;
}

}  // namespace
}  // namespace halfshade
