#include "solver/pipeline/solve_fields.h"

#include "solver/direct/direct_light.h"
#include "solver/elements/element_field.h"
#include "solver/pipeline/light_at_points.h"
#include "solver/pipeline/prepared_scene.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/touching_lights.h"
#include "tests/support/triangle_soups.h"
#include "tests/support/true_error.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace halfshade {
namespace {

/// Low corner, high corner, height; seen from above.
std::vector<Vec3> square_at(double low, double high, double z) {
  return {{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}};
}

std::vector<Vec3> reversed(const std::vector<Vec3>& ring) { return {ring.rbegin(), ring.rend()}; }

/// A unit light at z = 2 that looks down, an occluder at z = 1, a floor at z = 0; all black.
Scene shadow_scene(double occluder, double floor_low, double floor_high) {
  Scene scene;
  const int black = test::add_material(scene, 0, 0), light = test::add_material(scene, 0, 1);
  test::add_polygon(scene, reversed(square_at(-.5, .5, 2)), light);
  test::add_polygon(scene, square_at(-occluder / 2, occluder / 2, 1), black);
  test::add_polygon(scene, square_at(floor_low, floor_high, 0), black);
  return scene;
}

Scene soft_shadow() { return shadow_scene(0.5, -2, 2); }
/// data/s1.obj without its reflectance.
Scene black_s1() { return shadow_scene(0.75, -1.9371, 1.8613); }

SolveOptions within(double tolerance) {
  SolveOptions options;
  options.tolerance = tolerance;
  return options;
}

/// Error of the irradiance in the L2 norm relative to it, from exact values at `count` random
/// points, as many on each part of the area.
double true_error(const SolveResult& result, int count) {
  const DirectLightIndex exact(result.scene);
  const ElementTable& elements = result.elements;
  std::vector<double> sums(elements.area.size());
  std::partial_sum(elements.area.begin(), elements.area.end(), sums.begin());
  test::Random random(4);
  double error = 0, norm = 0;
  for (int i = 0; i < count; ++i) {
    const double up_to = (i + random(0, 1)) / count * sums.back();
    const auto e =
        static_cast<int>(std::lower_bound(sums.begin(), sums.end() - 1, up_to) - sums.begin());
    const double across = std::sqrt(random(0, 1)), along = random(0, 1);
    const TrianglePlace place(across * (1 - along), across * along);
    const Rgb truth =
        exact.irradiance({position(elements.triangle(e), place), elements.normal[at(e)]})
            .irradiance;
    error += (truth - value_at(result.irradiance, e, place)).matrix().squaredNorm();
    norm += truth.matrix().squaredNorm();
  }
  return std::sqrt(error / norm);
}

/// The same by a fine rule on each element, which finds what a few points rarely meet.
double fine_error(const SolveResult& result, int parts) {
  const DirectLightIndex exact(result.scene);
  double error = 0, norm = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    const auto triangle = result.elements.triangle(e);
    const double area = result.elements.area[at(e)];
    error +=
        area * test::triangle_mean(parts, [&](const TrianglePlace& place) {
          const SurfacePoint point = {position(triangle, place), result.elements.normal[at(e)]};
          const Rgb off =
              exact.irradiance(point).irradiance - value_at(result.irradiance, e, place);
          return off.matrix().squaredNorm();
        });
    norm += area * result.irradiance.of(e).matrix().squaredNorm();
  }
  return std::sqrt(error / norm);
}

void expect_met(const SolveResult& result, double tolerance) {
  EXPECT_EQ(result.not_reached, "");
  EXPECT_FALSE(result.interrupted);
  EXPECT_LE(result.relative_error, tolerance);
  const double actual = true_error(result, 2000);
  EXPECT_LE(actual, tolerance);
  EXPECT_GE(result.relative_error, 0.9 * actual);
  const double fine = fine_error(result, 2);
  EXPECT_LE(fine, tolerance);
  EXPECT_GE(result.relative_error, 0.9 * fine);
  // What is wrong within a corner, few points find.
  EXPECT_LE(result.relative_error, 3 * std::max(actual, fine));
}

/// Power that arrives on each surface of the strongest channel, and its area.
std::vector<Vec2> power_and_area(const SolveResult& result) {
  std::vector<Vec2> sums(result.scene.surfaces.size(), Vec2::Zero());
  for (int e = 0; e < result.elements.count(); ++e) {
    const double area = result.elements.area[at(e)];
    sums[at(result.elements.surface[at(e)])] +=
        area * Vec2(result.solution.irradiance.row(e).maxCoeff(), 1);
  }
  return sums;
}

double mean_over_surfaces(const SolveResult& result) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& surface : power_and_area(result)) sum += surface;
  return sum.x() / sum.y();
}

TEST(SolveFields, ASoftShadowToAThousandthTakesFewElements) {
  const SolveResult result = solve(soft_shadow(), within(1e-3));
  expect_met(result, 1e-3);
  EXPECT_LE(result.elements.count(), 500);
}

TEST(SolveFields, ASoftShadowToAMillionth) { expect_met(solve(soft_shadow(), within(1e-6)), 1e-6); }

TEST(SolveFields, S1ToTenToTheMinusEight) {
  const SolveResult result = solve(black_s1(), within(1e-8));
  EXPECT_EQ(result.not_reached, "");
  EXPECT_LE(result.refinement.unknowns, 5000u);
  EXPECT_GT(result.curves, 0u);
  EXPECT_LE(true_error(result, 2000), 1e-8);
}

TEST(SolveFields, MeansAreThoseOfThePolynomials) {
  const SolveResult result = solve(soft_shadow(), within(1e-3));
  EXPECT_TRUE((result.solution.irradiance == means(result.irradiance)).all());
  EXPECT_TRUE((result.solution.direct_irradiance == means(result.direct)).all());
  EXPECT_EQ(result.irradiance.count(), result.elements.count());
  EXPECT_EQ(result.solution.error_estimate.size(), result.elements.count());
  EXPECT_EQ(result.solution.region.size(), result.elements.corners.size());
}

TEST(SolveFields, LimitsThatKeepFromTheToleranceAreNamed) {
  SolveOptions options = within(1e-4);
  options.max_elements = 8;
  const SolveResult few = solve(soft_shadow(), options);
  EXPECT_NE(few.not_reached.find("--max-elements"), std::string::npos) << few.not_reached;
  EXPECT_GT(few.relative_error, 1e-4);
  EXPECT_LE(few.elements.count(), 8);
  EXPECT_GE(few.relative_error, 0.8 * true_error(few, 2000));
  options = within(1e-4);
  options.max_unknowns = 300;
  const SolveResult small = solve(soft_shadow(), options);
  EXPECT_NE(small.not_reached.find("--max-unknowns"), std::string::npos) << small.not_reached;
  options = within(1e-4);
  options.refine = Refinement::uniform;
  options.elements = 200;
  EXPECT_EQ(solve(soft_shadow(), options).not_reached, "") << "elements that were asked for";
}

TEST(SolveFields, AClosedCubeKeepsItsPower) {
  const Scene cube = test::lit_cube({.5, .5, .5, .5, .5, .5});
  const SolveResult result = solve(cube, within(1e-2));
  EXPECT_EQ(result.not_reached, "");
  // Φ / (A (1 − ρ))
  EXPECT_NEAR(mean_over_surfaces(result), 1. / 3, 1e-3 / 3);
  EXPECT_GT(result.reflected.systems, 0);
}

TEST(SolveFields, WeakChannelsAreReflectedLikeStrongOnes) {
  Scene cube = test::lit_cube({.5, .5, .5, .5, .5, .5});
  const Rgb strength(1e155, 1, 1e-170);
  for (Material& material : cube.materials) material.exitance *= strength;
  const SolveResult result = solve(cube, within(1e-2));
  Rgb power = Rgb::Zero();
  double area = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    power += result.elements.area[at(e)] * result.solution.irradiance.row(e).transpose();
    area += result.elements.area[at(e)];
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(power[k] / area / strength[k], 1. / 3, 1e-3 / 3) << k;
}

TEST(SolveFields, WithoutBouncesAllLightIsDirect) {
  SolveOptions options = within(1e-2);
  options.radiosity.bounces = 0;
  const SolveResult result = solve(test::lit_cube({.5, .5, .5, .5, .5, .5}), options);
  EXPECT_LT((result.solution.irradiance - result.solution.direct_irradiance).abs().maxCoeff(),
            1e-12);
  // The light breaks where the walls meet the emitter, at the border of elements.
  EXPECT_LE(fine_error(result, 4), 1.1e-2);
}

TEST(SolveFields, DirectLightIsApartFromReflectedLight) {
  const SolveResult result = solve(test::lit_cube({.5, .5, .5, .5, .5, .5}), within(1e-2));
  SolveResult direct = result;
  direct.irradiance = result.direct;
  EXPECT_LE(true_error(direct, 2000), 1e-2);
  EXPECT_GT((result.solution.irradiance - result.solution.direct_irradiance).minCoeff(), 0);
}

TEST(SolveFields, AgreeWithTheMatrixInARoom) {
  Scene room = test::l_room(true);
  room.materials[4].exitance = Rgb::Constant(3);
  SolveOptions options = within(1e-2);
  const std::vector<Vec2> fields = power_and_area(solve(room, options));
  options.method = SolveMethod::matrix;
  options.elements = 1500;
  const std::vector<Vec2> matrix = power_and_area(solve(room, options));
  ASSERT_EQ(fields.size(), matrix.size());
  for (std::size_t s = 0; s < fields.size(); ++s) {
    EXPECT_NEAR(fields[s].y(), matrix[s].y(), 1e-9) << s;
    EXPECT_NEAR(fields[s].x() / matrix[s].x(), 1, 0.02) << s;
  }
}

TEST(SolveFields, BytesDoNotDependOnThreads) {
  for (const Scene& scene : {soft_shadow(), test::lit_cube({.5, .4, .3, .2, .5, .6})}) {
    const auto solved = [&](int threads) {
      return tbb::task_arena(threads).execute([&] { return solve(scene, within(1e-2)); });
    };
    const SolveResult one = solved(1), two = solved(2);
    EXPECT_EQ(one.elements.points, two.elements.points);
    EXPECT_EQ(one.elements.corners, two.elements.corners);
    EXPECT_EQ(one.irradiance.order, two.irradiance.order);
    ASSERT_EQ(one.irradiance.coefficients.rows(), two.irradiance.coefficients.rows());
    EXPECT_TRUE((one.irradiance.coefficients == two.irradiance.coefficients).all());
    EXPECT_TRUE((one.direct.coefficients == two.direct.coefficients).all());
    EXPECT_EQ(one.relative_error, two.relative_error);
  }
}

TEST(SolveFields, ASmallThingJustAboveTheFloorIsNotOverlooked) {
  for (const double size : {0.1, 0.05})
    for (const double tolerance : {1e-2, 1e-3}) {
      Scene scene;
      const int black = test::add_material(scene, 0, 0), light = test::add_material(scene, 0, 1);
      test::add_polygon(scene, reversed(square_at(-.5, .5, 2)), light);
      test::add_polygon(scene, square_at(-2, 2, 0), black);
      const Vec3 low(0.613, 0.422, 0.1 * size);
      for (const auto& face : test::box_faces(low, low + Vec3(size, size, 0.9 * size), false))
        test::add_polygon(scene, face, black);
      const SolveResult result = solve(scene, within(tolerance));
      EXPECT_LE(fine_error(result, 4), tolerance) << size;
    }
}

/// A light that stands on a floor.
Scene standing_light() {
  Scene scene;
  const int black = test::add_material(scene, 0, 0), light = test::add_material(scene, 0, 1);
  test::add_polygon(scene, square_at(-2, 2, 0), black);
  test::add_polygon(scene, {{-.5, 0, 0}, {.5, 0, 0}, {.5, 0, 1}, {-.5, 0, 1}}, light);
  return scene;
}

/// ∫ (irradiance − exact)² on a disc around a corner of the light, on rings ever narrower.
double square_error_around_corner(const SolveResult& result) {
  constexpr int directions = 64;
  constexpr double ratio = 0.8;
  std::vector<SurfacePoint> points;
  std::vector<double> areas;
  for (double radius = 0.3; radius > 1e-4; radius *= ratio)
    for (int k = 0; k < directions; ++k) {
      const double angle = 2 * M_PI * (k + 0.5) / directions, middle = radius * (1 + ratio) / 2;
      points.push_back(
          {{0.5 + middle * std::cos(angle), middle * std::sin(angle), 0}, Vec3::UnitZ()});
      areas.push_back(M_PI * radius * radius * (1 - ratio * ratio) / directions);
    }
  const std::vector<PointLight> found = light_at_points(result, points);
  const DirectLightIndex exact(result.scene);
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += areas[i] *
           (found[i].irradiance - exact.irradiance(points[i]).irradiance).matrix().squaredNorm();
  return sum;
}

TEST(SolveFields, TheCornersOfALightThatTouchesAreNotOverlooked) {
  for (const double tolerance : {1e-2, 1e-3}) {
    const SolveResult result = solve(standing_light(), within(tolerance));
    double norm = 0;
    for (int e = 0; e < result.elements.count(); ++e)
      norm += result.elements.area[at(e)] * result.irradiance.of(e).matrix().squaredNorm();
    const double error = std::sqrt(square_error_around_corner(result) / norm);
    EXPECT_LT(error, 0.7 * tolerance) << tolerance;
    expect_met(result, tolerance);
  }
}

/// Errors in most of these went unseen once: narrow gaps under lights and things, and corners that
/// touch.
TEST(SolveFields, NarrowGapsAndTouchingCornersAreNotOverlooked) {
  for (const auto& [seed, tolerance] :
       {std::pair(47, 1e-3), std::pair(22, 1e-2), std::pair(20, 1e-2), std::pair(37, 1e-4),
        std::pair(41, 1e-2), std::pair(59, 1e-4)}) {
    const SolveResult result =
        solve(test::touching_light(static_cast<std::uint64_t>(seed)), within(tolerance));
    EXPECT_EQ(result.not_reached, "") << seed;
    const double fine = fine_error(result, 2);
    EXPECT_LE(fine, tolerance) << seed;
    EXPECT_GE(result.relative_error, fine) << seed;
    EXPECT_LE(result.relative_error, 3 * fine) << seed;
  }
}

TEST(SolveFields, ConvexOccludersGetTheAccuracyAsked) {
  for (std::uint64_t seed = 0; seed < 5; ++seed)
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      const SolveResult result = solve(test::convex_occluders(seed), within(tolerance));
      EXPECT_EQ(result.not_reached, "") << seed;
      const double fine = fine_error(result, 1);
      EXPECT_LE(fine, tolerance) << seed;
      EXPECT_GE(result.relative_error, 0.9 * fine) << seed;
      EXPECT_LE(result.relative_error, 3 * fine) << seed;
    }
}

TEST(SolveFields, FewElementsAreALimitNotAFailure) {
  SolveOptions options = within(1e-4);
  options.max_elements = 20;
  const SolveResult few = solve(soft_shadow(), options);
  EXPECT_NE(few.not_reached.find("--max-elements"), std::string::npos) << few.not_reached;
}

TEST(SolveFields, EndsWithASentenceWhereTooMuchLiesBeforeTheLight) {
  SolveOptions options;
  options.max_unknowns = 300;
  options.force.exact_direct_light = true;
  const SolveResult result =
      solve(PreparedScene(test::unit_soup(150, 2), {}, {.contacts = false}), options);
  EXPECT_EQ(result.refinement.limit, FieldLimit::work);
  EXPECT_GT(result.relative_error, options.tolerance);
  EXPECT_NE(result.not_reached.find("faces behind faces"), std::string::npos) << result.not_reached;
  EXPECT_TRUE(result.solution.irradiance.allFinite());
  EXPECT_GT(result.solution.irradiance.maxCoeff(), 0);
}

TEST(SolveFields, EndsWithASentenceWhereRaysToEmittersAreTooMany) {
  SolveOptions options;
  options.max_unknowns = 3000;
  const SolveResult result =
      solve(PreparedScene(test::unit_soup(150, 2), {}, {.contacts = false}), options);
  EXPECT_TRUE(result.refinement.is_noisy);
  EXPECT_EQ(result.refinement.limit, FieldLimit::work);
  EXPECT_GT(result.relative_error, options.tolerance);
  EXPECT_NE(result.not_reached.find("rays to emitters"), std::string::npos) << result.not_reached;
  EXPECT_TRUE(result.solution.irradiance.allFinite());
}

}  // namespace
}  // namespace halfshade
