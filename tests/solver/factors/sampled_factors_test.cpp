#include "solver/factors/exchange_work.h"
#include "solver/factors/factor_matrix.h"
#include "solver/factors/row_rays.h"
#include "solver/factors/surface_exchange.h"
#include "tests/support/balls.h"
#include "tests/support/face_factors.h"
#include "tests/support/random.h"
#include "tests/support/scene_maker.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

FactorMatrix matrix_by(FactorMethod method, const Scene& scene, double tolerance,
                       FactorUnit unit = FactorUnit::face) {
  FactorOptions options;
  options.method = method;
  options.unit = unit;
  options.tolerance = tolerance;
  return form_factor_matrix(scene, options);
}

/// A room full of confetti that nothing is convex or closed about: walls and chips are groups.
Scene confetti(int chips) {
  Scene scene = test::lit_cube({0.5, 0.5, 0.5, 0.5, 0.5, 0.5});
  for (Face& face : scene.faces) face.group = 0;
  scene.groups = {"walls", "chips"};
  test::Random random(5);
  for (int k = 0; k < chips; ++k) {
    const Vec3 middle = random.point(0.05, 0.95);
    const std::size_t before = scene.faces.size();
    test::add_polygon(scene,
                      {middle + 0.02 * random.direction(), middle + 0.02 * random.direction(),
                       middle + 0.02 * random.direction()},
                      0);
    scene.faces[before].group = 1;
  }
  return scene;
}

TEST(SampledFactors, GoOnUntilTheTolerance) {
  const Scene scene = test::l_room(true);
  const FactorMatrix exact = matrix_by(FactorMethod::exact, scene, 1e-6);
  std::size_t before = 0;
  for (const double tolerance : {1e-2, 1e-3}) {
    const FactorMatrix sampled = matrix_by(FactorMethod::rays, scene, tolerance);
    EXPECT_EQ(sampled.report.method, FactorMethod::rays);
    EXPECT_EQ(sampled.report.rows_not_reached, 0);
    EXPECT_LE(sampled.error.maxCoeff(), tolerance);
    EXPECT_GT(sampled.report.rays, before);
    // Errors of independent rays go with the root of their number.
    EXPECT_LT(static_cast<double>(sampled.report.rays),
              std::max(2e5, 50. * static_cast<double>(before)));
    before = sampled.report.rays;
    test::expect_within_errors(sampled, exact);
  }
}

TEST(SampledFactors, ClaimNotMuchMoreThanTheyAreOff) {
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.method = FactorMethod::rays;
  std::vector<double> ratios;
  for (const Scene& scene : {test::l_room(true), test::table_scene()}) {
    const FactorMatrix exact = matrix_by(FactorMethod::exact, scene, 1e-6);
    for (const int rays : {3000, 10000, 30000, 100000}) {
      options.rays = rays;
      const FactorMatrix sampled = form_factor_matrix(scene, options);
      for (Eigen::Index i = 0; i < exact.area.size(); ++i) {
        const double off = std::max((sampled.factors - exact.factors).row(i).cwiseAbs().maxCoeff(),
                                    std::abs(sampled.space[i] - exact.space[i]));
        ratios.push_back(sampled.error[i] / (off + exact.error[i]));
      }
    }
  }
  std::sort(ratios.begin(), ratios.end());
  ASSERT_GT(ratios.size(), 40u);
  EXPECT_GT(ratios.front(), 1);
  EXPECT_LT(ratios[ratios.size() * 9 / 10], 10);
}

TEST(SampledFactors, TheNumberOfThreadsChangesNothing) {
  const FactorMatrix many = matrix_by(FactorMethod::rays, test::l_room(true), 1e-2);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const FactorMatrix single = matrix_by(FactorMethod::rays, test::l_room(true), 1e-2);
  EXPECT_TRUE((many.factors.array() == single.factors.array()).all());
  EXPECT_TRUE((many.error == single.error).all());
}

TEST(SampledFactors, AreTakenWhereExactOnesAreFarMoreWork) {
  const Scene scene = confetti(1500);
  const FactorMatrix matrix = matrix_by(FactorMethod::automatic, scene, 1e-2, FactorUnit::group);
  EXPECT_EQ(matrix.report.method, FactorMethod::rays);
  EXPECT_EQ(matrix.report.rows_not_reached, 0);
  ASSERT_EQ(matrix.names.size(), 2u);
  EXPECT_NEAR(matrix.row_sum[0], 1, 1e-2);
  EXPECT_NEAR(matrix.row_sum[1], 1, 1e-2);
  // Sparse and small, chips are alike to light that crosses the room: of its chords, 2/3 long in
  // the mean, each piece meets a chip with the chips' area, both sides, over four times the volume.
  const double density = 2 * matrix.area[1] / 4;
  EXPECT_NEAR(1 - matrix.factors(0, 0), density * 2 / 3, 0.3 * density);
}

TEST(SampledFactors, AreNotTakenWhereExactOnesAreLittleWorkOrRaysDoNotDo) {
  EXPECT_EQ(matrix_by(FactorMethod::automatic, test::l_room(true), 1e-2).report.method,
            FactorMethod::exact);
  const Scene scene = confetti(300);
  const FactorScene sound = make_factor_scene(scene, FactorUnit::group);
  const double seconds = exact_seconds(sound, make_sight_scene(sound.sound));
  EXPECT_GT(seconds, 1);
  EXPECT_LT(seconds, 60);
  EXPECT_FALSE(sampled_exchange_within(
      rays_in(seconds), sound, make_reflecting_scene(sound.sound),
      {.unit = FactorUnit::group, .method = FactorMethod::rays, .tolerance = 1e-6}, {}));
}

/// Most facets of balls see all of each other, or nothing: some thousand of three million pairs are
/// work. (With a quarter of all it would take minutes.)
TEST(SampledFactors, BallsAreLittleExactWork) {
  const FactorScene sound = make_factor_scene(test::room_with_balls(2, 3), FactorUnit::material);
  EXPECT_LT(exact_seconds(sound, make_sight_scene(sound.sound)), 20);
}

TEST(RowPlaces, AreSpreadByArea) {
  const Scene scene = test::SceneMaker().up({0, 0}, {3, 1}, 0).up({0, 0}, {1, 1}, 1).scene;
  const FactorScene sound = make_factor_scene(scene, FactorUnit::material);
  const ReflectingScene reflecting = make_reflecting_scene(sound.sound);
  const RowPlaces places(reflecting, roots_of_rows(sound, reflecting).front());
  constexpr int side = 40;
  int low = 0, left = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const Vec3 p = places.at_numbers((i + 0.5) / side, (j + 0.5) / side).position;
      EXPECT_LT(std::abs(p.z() * (p.z() - 1)), 1e-12);
      low += p.z() < 0.5 ? 1 : 0;
      left += p.z() < 0.5 && p.x() < 1.5 ? 1 : 0;
    }
  EXPECT_EQ(low, side * side * 3 / 4);
  EXPECT_NEAR(left, low / 2, side);
}

}  // namespace
}  // namespace halfshade
