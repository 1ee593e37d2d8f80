#include "solver/pipeline/solve.h"

#include "meshing/core/error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stop_token>

namespace halfshade {
namespace {

/// Gives every face a random reflectance in [0.05, 0.95] per channel and the exitance that makes
/// the radiosity 1.
void make_furnace(Scene& scene, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0.05, 0.95);
  for (Material& material : scene.materials)
    for (int c = 0; c < 3; ++c) {
      material.rho[c] = u(random);
      material.exitance[c] = 1 - material.rho[c];
    }
}

void set_all(Scene& scene, double rho, double exitance) {
  for (Material& material : scene.materials) {
    material.rho = Rgb::Constant(rho);
    material.exitance = Rgb::Constant(exitance);
  }
}

SolveOptions with_length(double max_length) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.max_length = max_length;
  options.radiosity.tolerance = 1e-13;
  return options;
}

Scene cube() {
  return test::room({1, 1, 1}, {{{.5, 1}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}}});
}

double furnace_error(const SolveResult& result) {
  return (result.solution.radiosity - 1).abs().maxCoeff();
}

TEST(WhiteFurnace, ClosedCube) {
  for (const double length : {1., 0.4, 0.13}) {
    Scene scene = cube();
    make_furnace(scene, 1);
    const SolveResult result = solve(scene, with_length(length));
    EXPECT_LE(furnace_error(result), 1e-10) << result.elements.count() << " elements";
    EXPECT_TRUE(result.exchange.closure_enforced);
    EXPECT_GT(result.exchange.closure_error_max, 0);
    EXPECT_LE(result.exchange.closure_error_max, 5e-3);
  }
}

TEST(WhiteFurnace, LRoomWithAnInnerObstruction) {
  for (const double length : {0.5, 0.2, 0.12}) {
    Scene scene = test::l_room(true);
    make_furnace(scene, 2);
    const SolveResult result = solve(scene, with_length(length));
    EXPECT_LE(furnace_error(result), 1e-10) << result.elements.count() << " elements";
    EXPECT_TRUE(result.exchange.closure_enforced);
    EXPECT_GT(result.exchange.rays, 0u);
    EXPECT_GT(result.exchange.closure_error_max, 0);
    EXPECT_LE(result.exchange.closure_error_max, 5e-3) << length;
  }
}

TEST(WhiteFurnace, CubeWithATwoSidedSheet) {
  Scene scene = cube();
  const int sheet = test::add_material(scene, 0.5, 0);
  test::add_polygon(scene, {{.2, .3, .4}, {.7, .3, .5}, {.7, .8, .5}, {.2, .8, .4}}, sheet);
  scene.materials[static_cast<std::size_t>(sheet)].two_sided = true;
  make_furnace(scene, 4);
  const SolveResult result = solve(scene, with_length(0.3));
  EXPECT_EQ(result.scene.surfaces.size(), 8u);
  EXPECT_TRUE(result.exchange.closed);
  EXPECT_LE(furnace_error(result), 1e-10);
  scene.materials[static_cast<std::size_t>(sheet)].two_sided = false;
  EXPECT_FALSE(solve(scene, with_length(0.3)).exchange.closed) << "its back swallows light";
}

TEST(WhiteFurnace, WithoutEnforcementTheErrorIsThatOfTheClosure) {
  Scene scene = test::l_room(true);
  make_furnace(scene, 3);
  SolveOptions options = with_length(0.3);
  options.exchange.closure = Closure::leave;
  const SolveResult result = solve(scene, options);
  EXPECT_GT(furnace_error(result), 1e-8);
  // ‖B − 1‖ ≤ ρ_max ε / (1 − ρ_max (1 + ε)), with ε the largest closure error.
  EXPECT_LE(furnace_error(result), 0.95 * result.exchange.closure_error_max / 0.045);
}

TEST(UniformScene, RadiosityIsTheGeometricSum) {
  Scene scene = test::l_room(true);
  set_all(scene, 0.75, 0.5);
  EXPECT_LE((solve(scene, with_length(0.4)).solution.radiosity - 2).abs().maxCoeff(), 1e-9);
}

TEST(FluxBalance, MeanIrradianceOfALRoomIsExact) {
  Scene scene = test::l_room(true);
  const double rho = 0.6, E = 3;
  set_all(scene, rho, 0);
  scene.materials[4].exitance = Rgb::Constant(E);  // the wall at x = 1 above y = 1, 1 × 1 large
  const SolveResult result = solve(scene, with_length(0.25));
  double flux = 0, area = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    const double a = result.elements.area[static_cast<std::size_t>(e)];
    flux += a * result.solution.irradiance(e, 0);
    area += a;
  }
  const double true_area = 2 * 3 + 8 + 2 * .09 + 4 * .15;
  EXPECT_NEAR(area, true_area, 1e-12);
  EXPECT_NEAR(flux / area, E / (true_area * (1 - rho)), 1e-6 * flux / area);
  EXPECT_LE(result.radiosity.channel[0].balance, 1e-9);
}

TEST(DirectLight, ByClosedFormsAndByTheMatrixAgreeInTheMean) {
  // Two ways that share no visibility code: silhouettes at points, rays between elements.
  Scene scene = cube();
  set_all(scene, 0.5, 0);
  scene.materials[5].exitance = Rgb::Constant(1);
  const int sheet = test::add_material(scene, 0.5, 0);
  test::add_polygon(scene, {{.2, .3, .4}, {.7, .3, .5}, {.7, .8, .5}, {.2, .8, .4}}, sheet);
  scene.materials[static_cast<std::size_t>(sheet)].two_sided = true;
  const auto means = [&](DirectLightBy way) {
    SolveOptions options;
    options.method = SolveMethod::matrix;
    options.elements = 1500;
    options.direct_light = way;
    const SolveResult result = solve(scene, options);
    Eigen::ArrayXd power = Eigen::ArrayXd::Zero(8), area = power;
    for (int e = 0; e < result.elements.count(); ++e) {
      const auto k = static_cast<std::size_t>(e);
      const int r = result.elements.surface[k];
      power[r] += result.elements.area[k] * result.solution.direct_irradiance(e, 0);
      area[r] += result.elements.area[k];
    }
    EXPECT_LE(result.radiosity.channel[0].balance, 1e-9);
    EXPECT_EQ(result.solution.region.empty(), way == DirectLightBy::matrix);
    return Eigen::ArrayXd(power / area);
  };
  const Eigen::ArrayXd exact = means(DirectLightBy::exact), rays = means(DirectLightBy::matrix);
  EXPECT_LE((exact - rays).abs().maxCoeff(), 2e-4);
  EXPECT_GT(exact.maxCoeff(), 0.4);
}

TEST(ConjugateGradients, IterationsDoNotGrowWithTheMesh) {
  Scene scene = cube();
  set_all(scene, 0.999, 0);
  scene.materials[0].exitance = Rgb::Constant(1);
  std::vector<int> counts;
  // Triangles half the size of the squares of an n × n grid, and fewer than those of the next.
  for (const int n : {4, 8, 16, 32}) {
    SolveOptions options;
    options.method = SolveMethod::matrix;
    options.elements = 6 * n * n;
    options.radiosity.tolerance = 1e-10;
    const SolveResult result = solve(scene, options);
    EXPECT_LE(result.radiosity.channel[0].iterations, 20) << result.elements.count();
    EXPECT_LE(result.radiosity.channel[0].residual, 1e-10);
    EXPECT_GT(result.elements.count(), 4 * n * n);
  }
}

TEST(Solve, RotationScaleAndTranslationDoNotChangeRadiosities) {
  const auto face_means = [](const SolveResult& result) {
    Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(6), area = mean;
    for (int e = 0; e < result.elements.count(); ++e) {
      const auto k = static_cast<std::size_t>(e);
      mean[result.elements.face[k]] += result.elements.area[k] * result.solution.radiosity(e, 0);
      area[result.elements.face[k]] += result.elements.area[k];
    }
    return Eigen::ArrayXd(mean / area);
  };
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 1000;
  const Eigen::ArrayXd expected = face_means(solve(cube(), options));
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.8, Vec3(3, 1, 2).normalized()).toRotationMatrix();
  for (const auto& [scale, shift] : {std::pair{1., 0.}, {1e-6, 0.}, {1e6, 0.}, {1., 1e6}}) {
    Scene scene = cube();
    for (Vec3& v : scene.vertices) v = scale * (R * v) + Vec3(shift, -shift, 2 * shift);
    const Eigen::ArrayXd mean = face_means(solve(scene, options));
    EXPECT_LE(((mean - expected) / expected).abs().maxCoeff(), 2e-3)
        << "scale " << scale << ", shift " << shift;
  }
}

TEST(Solve, ReportsItsStagesAndWhatItLeftOut) {
  Scene scene = cube();
  set_all(scene, 0, 1);
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 200;
  const SolveResult result = solve(scene, options);
  ASSERT_FALSE(result.stages.empty());
  EXPECT_EQ(result.stages.front().name, "repair");
  EXPECT_EQ(result.stages.front().count, 6u);
  bool left_out = false;
  for (const StageReport& stage : result.stages) left_out |= !stage.left_out_because.empty();
  EXPECT_TRUE(left_out) << "nothing reflects";
}

TEST(Solve, StopsWithAValidPartialResult) {
  std::stop_source stop;
  stop.request_stop();
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 500;
  const SolveResult result = solve(cube(), options, {stop.get_token(), {}});
  EXPECT_TRUE(result.interrupted);
  EXPECT_GT(result.elements.count(), 0);
  EXPECT_TRUE(result.solution.radiosity.allFinite());
  EXPECT_EQ(result.solution.radiosity.rows(), result.elements.count());
}

TEST(Solve, RefusesWhatItCannotSolve) {
  Scene dark = cube();
  set_all(dark, 0.5, 0);
  EXPECT_THROW(solve(dark), Error);
  SolveOptions few;
  few.max_elements = 10;
  few.max_length = 0.1;
  try {
    solve(cube(), few);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::too_large);
  }
}

}  // namespace
}  // namespace halfshade
