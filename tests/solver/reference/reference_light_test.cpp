#include "solver/reference/reference_light.h"

#include "meshing/core/error.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "tests/support/analytic.h"
#include "tests/support/expect_error.h"
#include "tests/support/painted_sphere.h"
#include "tests/support/scenes.h"
#include "tests/support/shadow_scenes.h"
#include "tests/support/z_scores.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>

namespace halfshade {
namespace {

using Points = std::vector<ReferencePoint>;

const Vec3 up = Vec3::UnitZ();

/// Points over the unit square at a height, looking up, `side`² of them, one in each cell.
Points over_square(int side, double low, double high, double z, test::Random& random) {
  Points points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const Vec2 p(i + random(0, 1), j + random(0, 1));
      const Vec2 place = Vec2::Constant(low) + (high - low) / side * p;
      points.push_back({{place.x(), place.y(), z}, up});
    }
  return points;
}

/// Each wall gives what it takes: with exitance 1 − ρ it sends 1 everywhere, and 1 arrives.
Scene furnace(Scene scene, unsigned seed) {
  test::Random random(seed);
  for (Material& m : scene.materials) {
    for (double& rho : m.rho) rho = random(0, 0.9);
    m.exitance = 1 - m.rho;
  }
  return scene;
}

/// Errors of the total where 1 is right, in standard errors: one channel a point.
std::vector<double> scores_of_one(const ReferenceLight& light) {
  std::vector<double> scores;
  for (std::size_t k = 0; k < light.values.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k % 3);
    scores.push_back((light.values[k].total[c] - 1) / light.standard_errors[k].total[c]);
  }
  return scores;
}

TEST(ReferenceLight, IsRightAtThePointsOfS1) {
  const Points points = {{{0, 0, 0}, up},      {{0.2, -0.2, 0}, up}, {{0.5, 0, 0}, up},
                         {{0.75, 0.3, 0}, up}, {{1.25, 0, 0}, up},   {{1.5, 0.2, 0}, up},
                         {{1.5, 0.2, 0}, -up}};
  constexpr double want[] = {0, 0, 0.018916915317, 0.033762803811, 0.040681704379, 0.0322713046224,
                             0};
  SoundScene scene = test::s1();
  for (Material& m : scene.materials) m.rho.setZero();
  const ReferenceLight light = reference_light(scene, points, {.samples = 65536});
  EXPECT_TRUE(light.complete);
  EXPECT_EQ(light.samples, 65536);
  for (std::size_t k = 0; k < std::size(want); ++k) {
    const Rgb& found = light.values[k].direct;
    const double error = light.standard_errors[k].direct[0];
    EXPECT_LE(std::abs(found[0] - want[k]), 3.5 * error) << k;
    EXPECT_LE(error, 1e-3 * want[k]) << k;
    EXPECT_EQ(found[1], found[0]);
    EXPECT_EQ(light.values[k].reflected[0], 0) << "all is black";
    EXPECT_EQ(light.values[k].total[0], found[0]);
  }
}

TEST(ReferenceLight, ErrorsOfDirectLightAreDistributedAsTheyShould) {
  test::Random random(1);
  std::vector<double> scores;
  const SoundScene scenes[] = {test::s1(), test::bars(4), test::boxes_on_floor()};
  for (const SoundScene& scene : scenes) {
    const DirectLightIndex exact(scene);
    const Points points = over_square(12, -1.4, 1.4, 1e-3, random);
    const ReferenceLight light = reference_light(scene, points, {.samples = 1024});
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double error = light.standard_errors[k].direct[0];
      const double truth = exact.irradiance({points[k].position, up}).irradiance[0];
      if (error > 0) scores.push_back((light.values[k].direct[0] - truth) / error);
      if (truth == 0) {
        EXPECT_EQ(light.values[k].direct[0], 0);
      }
    }
  }
  EXPECT_GE(scores.size(), 250u);
  test::expect_right_distribution(scores, 31);
}

TEST(ReferenceLight, ErrorsInFurnacesAreDistributedAsTheyShould) {
  test::Random random(2);
  const SoundScene cube = make_sound(furnace(test::lit_cube({}), 3));
  const SoundScene room = make_sound(furnace(test::l_room(true), 4));
  std::vector<double> scores;
  for (const SoundScene* scene : {&cube, &room}) {
    const Points points = over_square(12, 0.01, 0.99, 0, random);
    const auto some = scores_of_one(reference_light(*scene, points, {.samples = 1024}));
    scores.insert(scores.end(), some.begin(), some.end());
  }
  EXPECT_GE(scores.size(), 280u);
  test::expect_right_distribution(scores, 31);
}

TEST(ReferenceLight, CountsReflections) {
  // Even walls: E (1 + ρ + … + ρⁿ) arrives after at most n reflections.
  Scene scene = test::lit_cube({});
  for (Material& m : scene.materials) {
    m.rho = Rgb(0.5, 0.8, 0);
    m.exitance = Rgb(1, 2, 3);
  }
  const SoundScene cube = make_sound(scene);
  const Points points = {{{0.3, 0.4, 0}, up}, {{0, 0.2, 0.9}, Vec3::UnitX()}};
  for (const int bounces : {0, 1, 2, 5, -1}) {
    const ReferenceLight light =
        reference_light(cube, points, {.samples = 4096, .bounces = bounces});
    for (std::size_t k = 0; k < points.size(); ++k) {
      Rgb want = Rgb::Zero(), term(1, 2, 3);
      for (int n = 0; n <= (bounces < 0 ? 200 : bounces); ++n, term *= Rgb(0.5, 0.8, 0))
        want += term;
      const ArrivingLight &found = light.values[k], &error = light.standard_errors[k];
      for (int c = 0; c < 3; ++c) {
        EXPECT_LE(std::abs(found.total[c] - want[c]), 4 * error.total[c]) << bounces << " " << c;
        EXPECT_LE(error.total[c], 0.02 * want[c]);
        if (bounces == 0 || c == 2) {
          EXPECT_EQ(found.reflected[c], 0);
        }
      }
    }
  }
}

TEST(ReferenceLight, IsTheSameAllOverAPaintedSphere) {
  // H = mean(E) / (1 − mean(ρ)) = (4/3) / (1/2), up to the flatness of 2,048 triangles.
  const SoundScene sphere = test::as_it_is(test::painted_sphere(4));
  Points points;
  for (std::size_t s = 0; s < sphere.surfaces.size(); s += 97) {
    const PlaneFrame& frame = sphere.surfaces[s].frame;
    points.push_back({frame.origin, frame.normal});
  }
  const ReferenceLight light = reference_light(sphere, points, {.samples = 2048});
  constexpr double want = 8. / 3, flatness = 2e-3 * want;
  double mean = 0, variance = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double error = light.standard_errors[k].total[0];
    EXPECT_NEAR(light.values[k].total[0], want, 4 * error + flatness);
    mean += light.values[k].total[0] / static_cast<double>(points.size());
    variance += std::pow(error / static_cast<double>(points.size()), 2);
  }
  EXPECT_NEAR(mean, want, 3 * std::sqrt(variance) + flatness);
  EXPECT_LT(std::sqrt(variance), flatness);
}

TEST(ReferenceLight, BalancesThePowerOfAnEmptyCube) {
  // The mean over all walls is Φ / (A (1 − ρ)), exactly: one wall of six emits, ρ = .7.
  const Scene scene = test::lit_cube({0.7, 0.7, 0.7, 0.7, 0.7, 0.7});
  constexpr int side = 12;
  test::Random random(5);
  Points points;
  for (int f = 0; f < 6; ++f) {
    const auto corner = face_corners(scene, f);
    const Vec3 e1 = corner[1] - corner[0], e2 = corner[3] - corner[0];
    for (const ReferencePoint& p : over_square(side, 0, 1, 0, random))
      points.push_back({corner[0] + p.position.x() * e1 + p.position.y() * e2, e1.cross(e2)});
  }
  const ReferenceLight light = reference_light(make_sound(scene), points, {.samples = 512});
  const auto n = static_cast<double>(points.size());
  double mean = 0, variance = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    mean += light.values[k].total[0] / n;
    variance += std::pow(light.standard_errors[k].total[0] / n, 2);
  }
  // Points are stratified: their places add less than 1e-3.
  const double want = 1. / (6 * 0.3);
  EXPECT_NEAR(mean, want, 4 * std::sqrt(variance) + 1e-3 * want);
  EXPECT_LT(std::sqrt(variance), 1e-3 * want);
}

/// The two triangles of a rectangle.
std::array<ReferenceTriangle, 2> halves(const std::vector<Vec3>& c) {
  return {ReferenceTriangle{c[0], c[1], c[2]}, {c[0], c[2], c[3]}};
}

TEST(ReferenceMeans, OfBareRectanglesAreTheirFormFactors) {
  // The floor of a black box of 1 × 2 × 3 is lit: others get their factors to it.
  const Scene scene = test::room({1, 2, 3}, {{{0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 1}, {0, 0}}});
  const SoundScene sound = make_sound(scene);
  std::vector<ReferenceTriangle> triangles;
  std::vector<double> want;
  const auto add = [&](const std::vector<Vec3>& corners, double factor) {
    for (const ReferenceTriangle& half : halves(corners)) triangles.push_back(half);
    want.push_back(factor);
  };
  add({Vec3(0, 0, 3), {0, 2, 3}, {1, 2, 3}, {1, 0, 3}}, test::opposed_rectangles(1, 2, 3));
  add({Vec3(0, 0, 0), {0, 2, 0}, {0, 2, 3}, {0, 0, 3}},
      test::offset_perpendicular_rectangles({0, 3}, {0, 2}, {0, 1}, {0, 2}));
  // An element in the middle of that wall.
  add({Vec3(0, 0.5, 0.25), {0, 0.75, 0.25}, {0, 0.75, 1}, {0, 0.5, 1}},
      test::offset_perpendicular_rectangles({0.25, 1}, {0.5, 0.75}, {0, 1}, {0, 2}));
  const ReferenceLight light = reference_means(sound, triangles, {.samples = 8192});
  for (std::size_t k = 0; k < want.size(); ++k) {
    double mean = 0, variance = 0;
    for (const std::size_t half : {2 * k, 2 * k + 1}) {
      mean += 0.5 * light.values[half].total[0];
      variance += 0.25 * std::pow(light.standard_errors[half].total[0], 2);
      EXPECT_EQ(light.values[half].reflected[0], 0);
    }
    EXPECT_LE(std::abs(mean - want[k]), 3.5 * std::sqrt(variance)) << k;
    EXPECT_LE(std::sqrt(variance), 1e-2 * want[k]) << k;
  }
}

TEST(ReferenceMeans, BalanceThePowerOfAnEmptyCube) {
  // As above, without the error of where points lie: Φ / (A (1 − ρ)).
  const Scene scene = test::lit_cube({0.7, 0.7, 0.7, 0.7, 0.7, 0.7});
  std::vector<ReferenceTriangle> triangles;
  for (int f = 0; f < 6; ++f)
    for (const ReferenceTriangle& half : halves(face_corners(scene, f))) triangles.push_back(half);
  const ReferenceLight light = reference_means(make_sound(scene), triangles, {.samples = 16384});
  double mean = 0, variance = 0;
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    mean += light.values[k].total[0] / 12;
    variance += std::pow(light.standard_errors[k].total[0] / 12, 2);
  }
  constexpr double want = 1. / (6 * 0.3);
  EXPECT_NEAR(mean, want, 3.5 * std::sqrt(variance));
  EXPECT_LT(std::sqrt(variance), 2e-3 * want);
}

TEST(ReferenceMeans, OfATriangleWithoutAnAreaAreRefused) {
  const std::vector<ReferenceTriangle> line = {{Vec3(0, 0, 0), {1, 0, 0}, {2, 0, 0}}};
  test::expect_error([&] { reference_means(test::s1(), line, {}); }, ErrorCode::contract,
                     {"triangle 0"});
}

TEST(ReferenceLight, MeetsTheSideThatFacesIt) {
  // A furnace with a two-sided sheet, and two sheets back to back of different reflectance.
  Scene scene = test::lit_cube({});
  const std::vector<Vec3> sheet = {{.3, .3, .5}, {.7, .3, .5}, {.7, .7, .5}, {.3, .7, .5}};
  std::vector<Vec3> lower = sheet;
  for (Vec3& p : lower) p.z() = 0.2;
  test::add_polygon(scene, sheet, test::add_material(scene, 0.9, 0));
  test::add_polygon(scene, {sheet.rbegin(), sheet.rend()}, test::add_material(scene, 0.1, 0));
  test::add_polygon(scene, lower, test::add_material(scene, 0.4, 0));
  scene.materials.back().two_sided = true;
  const SoundScene sound = make_sound(furnace(scene, 6));
  const Points points = {{{0.5, 0.45, 0}, up},    {{0.4, 0.5, 1}, -up},  {{0.4, 0.6, 0.5}, up},
                         {{0.5, 0.55, 0.5}, -up}, {{0.5, 0.5, 0.2}, up}, {{0.5, 0.45, 0.2}, -up}};
  const ReferenceLight light = reference_light(sound, points, {.samples = 8192});
  for (std::size_t k = 0; k < points.size(); ++k)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(light.values[k].total[c], 1, 4 * light.standard_errors[k].total[c]) << k;
}

TEST(ReferenceLight, DoesNotDependOnThreadsNorOnOtherPoints) {
  const SoundScene room = make_sound(furnace(test::l_room(true), 7));
  test::Random random(8);
  const Points points = over_square(6, 0.1, 0.9, 0, random);
  const auto run = [&](int threads, std::size_t count) {
    return tbb::task_arena(threads).execute(
        [&] { return reference_light(room, std::span(points).first(count), {.samples = 64}); });
  };
  const ReferenceLight one = run(1, 36), two = run(2, 36), few = run(2, 5);
  for (std::size_t k = 0; k < points.size(); ++k)
    for (const ReferenceLight* other : {&two, &few}) {
      if (k >= other->values.size()) continue;
      EXPECT_TRUE((one.values[k].total == other->values[k].total).all());
      EXPECT_TRUE((one.standard_errors[k].direct == other->standard_errors[k].direct).all());
    }
  const ReferenceLight rest =
      reference_light(room, std::span(points).subspan(5), {.samples = 64, .first = 5});
  EXPECT_TRUE((rest.values[1].total == one.values[6].total).all());
  const ReferenceLight seeded = reference_light(room, points, {.samples = 64, .seed = 1});
  EXPECT_FALSE((one.values[0].total == seeded.values[0].total).any());
}

TEST(ReferenceLight, IsNothingWhereNothingEmits) {
  Scene scene = test::lit_cube({0.5, 0.5, 0.5, 0.5, 0.5, 0.5});
  for (Material& m : scene.materials) m.exitance.setZero();
  const Points points = {{{0.3, 0.4, 0}, up}};
  const ReferenceLight light = reference_light(make_sound(scene), points, {});
  EXPECT_TRUE((light.values[0].total == 0).all());
  EXPECT_TRUE((light.standard_errors[0].total == 0).all());
}

TEST(ReferenceLight, CanBeStopped) {
  std::stop_source stop;
  stop.request_stop();
  const Points points = {{{0.3, 0.4, 0}, up}};
  const ReferenceLight light = reference_light(test::s1(), points, {}, {stop.get_token(), {}});
  EXPECT_FALSE(light.complete);
  EXPECT_EQ(light.values.size(), 1u);
}

TEST(ReferenceLight, RefusesWhatHasNoAnswer) {
  const Points points = {{{0.3, 0.4, 0}, up}};
  const SoundScene white = make_sound(test::lit_cube({1, 1, 1, 1, 1, 1}));
  test::expect_error([&] { reference_light(white, points, {}); }, ErrorCode::invalid_input,
                     {"absorbed"});
  for (const ReferenceOptions& wrong :
       {ReferenceOptions{.samples = 0}, {.batches = 1}, {.bounces = -2}})
    test::expect_error([&] { reference_light(white, points, wrong); }, ErrorCode::contract,
                       {"out of range"});
}

}  // namespace
}  // namespace halfshade
