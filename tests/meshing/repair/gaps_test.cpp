#include "meshing/repair/repair.h"
#include "tests/support/repair_scenes.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <gmock/gmock.h>

// Two-sided sheets close over and under others: a gap that is written in the file stays one, and
// what is flush but for the digits of the file is cut out, whichever way round the sheet goes.

namespace halfshade {
namespace {

using test::add_polygon;
using test::count;
using test::expect_surfaces_sound;
using test::rectangle;
using test::reversed;
using test::scene_of;
using test::total_area;

constexpr int grey = 0, two_sided = 3;

std::vector<Vec3> square(double size, double z) {
  return rectangle(-size / 2, -size / 2, size / 2, size / 2, z);
}

/// A floor that looks up and a two-sided sheet of size 1 over it.
Scene sheet_over_floor(double floor, double gap, bool up) {
  const std::vector<Vec3> sheet = square(1, gap);
  return scene_of({{square(floor, 0), grey}, {up ? sheet : reversed(sheet), two_sided}});
}

Eigen::AngleAxisd turn(int trial) {
  return Eigen::AngleAxisd(0.3 + trial, Vec3(1, trial, 3).normalized());
}

Scene turned(Scene scene, int trial) {
  for (Vec3& p : scene.vertices) p = turn(trial) * p;
  return scene;
}

void round_coordinates(Scene& scene, const std::function<double(double)>& round) {
  for (Vec3& p : scene.vertices)
    for (double& x : p) x = round(x);
}

void expect_floor_and_both_sides(const SoundScene& sound, double floor) {
  ASSERT_EQ(sound.surfaces.size(), 3u);
  EXPECT_NEAR(area(sound.surfaces[0]), floor * floor, 1e-6 * floor * floor);
  EXPECT_NE(sound.surfaces[0].plane, sound.surfaces[1].plane);
  EXPECT_EQ(sound.surfaces[1].plane, sound.surfaces[2].plane);
  EXPECT_TRUE(sound.repairs.empty());
}

TEST(MakeSound, LeavesTheGapUnderATwoSidedSheetWhicheverWayItLooks) {
  for (const double floor : {2., 4., 100., 1000.})
    for (const double gap : {1e-3, 1e-4, 5e-5, 3e-6, 1e-6, -1e-6, -1e-4})
      for (const bool up : {true, false}) {
        SCOPED_TRACE(fmt::format("floor {} gap {} up {}", floor, gap, up));
        const Scene scene = sheet_over_floor(floor, gap, up);
        expect_floor_and_both_sides(make_sound(scene), floor);
        for (int trial = 0; trial < 5; ++trial)
          expect_floor_and_both_sides(make_sound(turned(scene, trial)), floor);
      }
}

TEST(MakeSound, LeavesTheGapUnderATwoSidedSheetOfTheFloorsOwnOutline) {
  for (const bool up : {true, false})
    for (const double gap : {1e-6, 1e-8}) {
      const auto sheet = square(1, gap);
      const SoundScene sound =
          make_sound(scene_of({{square(1, 0), grey}, {up ? sheet : reversed(sheet), two_sided}}));
      expect_floor_and_both_sides(sound, 1);
    }
}

TEST(MakeSound, LeavesTheGapsBetweenSeveralTwoSidedSheets) {
  const SoundScene sound = make_sound(scene_of({{square(4, 0), two_sided},
                                                {square(2, 1e-6), two_sided},
                                                {reversed(square(1, 2e-6)), two_sided}}));
  EXPECT_EQ(sound.surfaces.size(), 6u);
  EXPECT_DOUBLE_EQ(total_area(sound), 2 * (16 + 4 + 1));
  EXPECT_TRUE(sound.repairs.empty());
}

TEST(MakeSound, LeavesTheGapBetweenTessellations) {
  // The tiles of the sheet are larger than those of the floor, so that they come first.
  for (const bool up : {true, false})
    for (int trial = 0; trial < 5; ++trial) {
      Scene scene = scene_of({});
      const auto add_tiles = [&](int count, double size, double z, int material) {
        const double step = size / count;
        for (int i = 0; i < count; ++i)
          for (int j = 0; j < count; ++j) {
            const auto tile = rectangle(i * step, j * step, (i + 1) * step, (j + 1) * step, z);
            add_polygon(scene, material == grey || up ? tile : reversed(tile), material);
          }
      };
      add_tiles(16, 4, 0, grey);
      add_tiles(3, 1.6, 1e-6, two_sided);
      const SoundScene sound = make_sound(turned(scene, trial));
      ASSERT_EQ(sound.surfaces.size(), 3u) << trial << up;
      EXPECT_NEAR(area(sound.surfaces[0]), 16, 1e-9);
      EXPECT_NEAR(area(sound.surfaces[1]), 1.6 * 1.6, 1e-9);
      EXPECT_EQ(count(sound, Repair::Kind::overlap_removed), 0);
    }
}

TEST(MakeSound, TellsOfGapsThatItShuts) {
  const auto shut = [](double gap, double away) {
    Scene scene =
        scene_of({{rectangle(0, 0, 1, 1, 0), grey}, {reversed(rectangle(0, 0, 1, 1, gap)), grey}});
    for (Vec3& p : scene.vertices) p.x() += away;
    const SoundScene sound = make_sound(scene);
    std::vector<double> gaps;
    for (const Repair& repair : sound.repairs)
      if (repair.kind == Repair::Kind::gap_shut) {
        EXPECT_EQ(repair.faces, (std::vector<int>{0, 1}));
        gaps.push_back(repair.size);
      }
    return gaps;
  };
  EXPECT_THAT(shut(1e-7, 100), testing::ElementsAre(testing::DoubleNear(1e-7, 1e-13)));
  EXPECT_THAT(shut(1e-6, 1234.5), testing::ElementsAre(testing::DoubleNear(1e-6, 1e-12)));
  EXPECT_TRUE(shut(1e-6, 100).empty()) << "it stays open";
  EXPECT_TRUE(shut(-1e-7, 100).empty()) << "back to back";
  EXPECT_TRUE(shut(0, 100).empty());
  EXPECT_TRUE(shut(1e-13, 100).empty()) << "arithmetic";
}

TEST(MakeSound, TellsOfNoGapsThatDigitsMake) {
  Scene scene = scene_of({{rectangle(0, 0, 1, 1), grey}, {reversed(rectangle(0, 0, 1, 1)), grey}});
  for (int trial = 0; trial < 20; ++trial) {
    Scene rounded = turned(scene, trial);
    for (Vec3& p : rounded.vertices) p += Vec3(3, 5, 7);
    // The other square a little off, as if its maker had computed it in another way.
    for (std::size_t v = 4; v < 8; ++v) rounded.vertices[v] += 2e-6 * Vec3(1, 2, 3);
    round_coordinates(rounded, [](double x) { return std::stod(fmt::format("{:.6g}", x)); });
    EXPECT_EQ(count(make_sound(rounded), Repair::Kind::gap_shut), 0) << trial;
  }
}

/// A slanted ceiling and a flush two-sided lamp.
Scene flush_lamp(int trial, bool turned_over) {
  const std::vector<Vec3> lamp = rectangle(1, 1, 2, 2);
  Scene scene =
      scene_of({{rectangle(0, 0, 4, 4), grey}, {turned_over ? reversed(lamp) : lamp, two_sided}});
  scene.materials[two_sided].exitance = Rgb::Constant(1);
  return turned(std::move(scene), trial);
}

void expect_lamp_cut_out(const Scene& scene) {
  const SoundScene sound = make_sound(scene);
  expect_surfaces_sound(sound);
  ASSERT_EQ(sound.surfaces.size(), 3u);
  EXPECT_NEAR(area(sound.surfaces[0]), 15, 1e-4);
  EXPECT_EQ(sound.surfaces[0].rings.size(), 2u);
  for (const Surface& surface : sound.surfaces) EXPECT_EQ(surface.plane, sound.surfaces[0].plane);
}

TEST(MakeSound, CutsOutAFlushTwoSidedLampWhateverTheDigitsOfTheFile) {
  const std::vector<std::function<double(double)>> files = {
      [](double x) { return x; },
      [](double x) { return std::round(1e6 * x) / 1e6; },
      [](double x) { return std::stod(fmt::format("{:.7g}", x)); },
      [](double x) { return static_cast<double>(static_cast<float>(x)); },
  };
  for (int trial = 0; trial < 20; ++trial)
    for (const bool turned_over : {false, true})
      for (std::size_t k = 0; k < files.size(); ++k) {
        SCOPED_TRACE(fmt::format("trial {} turned over {} file {}", trial, turned_over, k));
        Scene scene = flush_lamp(trial, turned_over);
        round_coordinates(scene, files[k]);
        expect_lamp_cut_out(scene);
      }
}

TEST(MakeSound, JoinsATwoSidedSheetThatIsBentByMoreThanItsDigits) {
  // Coordinates with a noise of some 1e-7, and all digits of it.
  for (int trial = 0; trial < 5; ++trial) {
    Scene scene = scene_of({});
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) add_polygon(scene, rectangle(i, j, i + 1, j + 1), two_sided);
    for (Vec3& p : scene.vertices) p.z() += 3e-7 * std::sin(7 * p.x() + 11 * p.y() + trial);
    const SoundScene sound = make_sound(turned(scene, trial));
    ASSERT_EQ(sound.surfaces.size(), 2u) << trial;
    EXPECT_NEAR(total_area(sound), 2 * 36, 1e-4);
  }
}

}  // namespace
}  // namespace halfshade
