#include "solver/exchange/exchange.h"

#include "meshing/core/error.h"
#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "solver/exchange/ray_factor.h"
#include "tests/support/analytic.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <numbers>
#include <stop_token>

namespace halfshade {
namespace {

struct MeshedRoom {
  SoundScene scene;
  ElementTable elements;

  MeshedRoom(const Scene& input, double max_length) : scene(make_sound(input)) {
    PlanarMeshOptions options;
    options.max_length = max_length;
    elements = PatchMesh(scene, options).elements();
  }

  Exchange exchange(const ExchangeOptions& options = {}, const Progress& progress = {}) const {
    return compute_exchange(scene, elements, VisibilityIndex(occluders(scene)), options, progress);
  }

  /// A F summed over the elements of two input faces.
  double between(const Exchange& exchange, int face_a, int face_b) const {
    double sum = 0;
    for (int e = 0; e < elements.count(); ++e)
      for (ExchangeMatrix::InnerIterator entry(exchange.matrix, e); entry; ++entry)
        if (elements.face[static_cast<std::size_t>(e)] == face_a &&
            elements.face[static_cast<std::size_t>(entry.col())] == face_b)
          sum += entry.value();
    return sum;
  }
};

Scene unit_room() {
  return test::room({1, 1, 1}, {{{.5, 1}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}}});
}

TEST(Exchange, ElementsOfACubeAddUpToTheClosedForms) {
  const MeshedRoom cube(unit_room(), 0.3);
  const Exchange exchange = cube.exchange({.tolerance = 1e-6, .closure = Closure::leave});
  EXPECT_NEAR(cube.between(exchange, 0, 1), 0.199824895698, 1e-6);
  EXPECT_NEAR(cube.between(exchange, 0, 2), 0.200043776075, 1e-6);
  EXPECT_NEAR(cube.between(exchange, 5, 3), 0.200043776075, 1e-6);
  EXPECT_EQ(cube.between(exchange, 2, 2), 0);
  EXPECT_EQ(exchange.report.rays, 0u) << "nothing can come between the walls of a cube";
  EXPECT_TRUE(exchange.report.closed);
  EXPECT_FALSE(exchange.report.closure_enforced);
  EXPECT_LE(exchange.report.closure_error_max, 1e-5);
}

TEST(Exchange, TheToleranceIsKept) {
  const MeshedRoom cube(unit_room(), 0.2);
  for (const double tolerance : {1e-2, 1e-4, 1e-6})
    EXPECT_LE(
        cube.exchange({.tolerance = tolerance, .closure = Closure::leave}).report.closure_error_max,
        tolerance);
}

TEST(Exchange, IsSymmetricToTheBitAndEnforcedClosureIsExact) {
  const MeshedRoom room(test::l_room(true), 0.4);
  const Exchange exchange = room.exchange();
  const ExchangeMatrix transposed = exchange.matrix.transpose();
  EXPECT_EQ((exchange.matrix - transposed).norm(), 0);
  EXPECT_TRUE(exchange.report.closed);
  ASSERT_TRUE(exchange.report.closure_enforced);
  const Eigen::ArrayXd sums =
      (exchange.matrix * Eigen::VectorXd::Ones(exchange.area.size())).array();
  EXPECT_LE((sums / exchange.area - 1).abs().maxCoeff(), 1e-12);
}

/// Two unit squares facing each other at distance 1 and, unless `cover` is 0, a square screen of
/// that half-width midway.
Scene squares_with_screen(double cover) {
  Scene scene;
  const int material = test::add_material(scene, 0.5, 1);
  test::add_polygon(scene, {{-.5, -.5, 0}, {.5, -.5, 0}, {.5, .5, 0}, {-.5, .5, 0}}, material);
  test::add_polygon(scene, {{-.5, .5, 1}, {.5, .5, 1}, {.5, -.5, 1}, {-.5, -.5, 1}}, material);
  if (cover > 0)
    test::add_polygon(
        scene, {{-cover, -cover, .5}, {cover, -cover, .5}, {cover, cover, .5}, {-cover, cover, .5}},
        material);
  return scene;
}

TEST(Exchange, AScreenBlocksWhatItCovers) {
  const auto through = [](double cover) {
    const MeshedRoom scene(squares_with_screen(cover), 0.2);
    const Exchange exchange = scene.exchange();
    EXPECT_FALSE(exchange.report.closed);
    return scene.between(exchange, 0, 1);
  };
  EXPECT_NEAR(through(0), 0.199824895698, 1e-5);
  EXPECT_EQ(through(0.5), 0) << "the screen is as large as the squares' hull";
  EXPECT_EQ(through(5), 0);
  // What a screen of half the width takes away is what passes through an opening of its size: the
  // kernel integrated over both squares on a grid, with the crossing point at mid-height tested
  // exactly.
  const int n = 25;  // odd, so that no grid point meets the screen's border
  double expected = 0;
  for (int a = 0; a < n * n; ++a)
    for (int b = 0; b < n * n; ++b) {
      const Vec3 x((a % n + .5) / n - .5, (a / n + .5) / n - .5, 0);
      const Vec3 y((b % n + .5) / n - .5, (b / n + .5) / n - .5, 1);
      const Vec3 middle = (x + y) / 2;
      if (std::max(std::abs(middle.x()), std::abs(middle.y())) < .25) continue;
      const double r2 = (y - x).squaredNorm();
      expected += 1 / (std::numbers::pi * r2 * r2) / std::pow(n, 4);
    }
  EXPECT_NEAR(through(0.25), expected, 0.01 * expected);
}

TEST(RayVisibility, WeighsRaysWithTheKernel) {
  // A small square light over one end of a long triangle; a screen hides the near part of the
  // triangle from it. In terms of area most is visible, in terms of light hardly anything.
  const PairEnd light{{Vec3(0, 0, .1), Vec3(0, 1e-3, .1), Vec3(1e-3, 0, .1)}, -Vec3::UnitZ(), -1};
  const PairEnd floor{{Vec3(0, -.2, 0), Vec3(2, 0, 0), Vec3(0, .2, 0)}, Vec3::UnitZ(), -1};
  TriangleSoup screen;
  screen.points = {{-1, -1, .05}, {.25, -1, .05}, {.25, 1, .05}, {-1, 1, .05}};
  screen.triangles = {{0, 1, 2}, {0, 2, 3}};
  screen.owner = {0, 0};
  screen.plane = {0, 0};
  // The screen hides x < 0.5. Light on the strip at x is ~ ∫ h²/(x² + y² + h²)² dy over |y| ≤ .2 −
  // .1x.
  const auto strip = [](double x) {
    return test::simpson([x](double y) { return 0.01 / std::pow(x * x + y * y + 0.01, 2); },
                         -.2 + .1 * x, .2 - .1 * x, 200);
  };
  const double expected = test::simpson(strip, 0.5, 2, 400) / test::simpson(strip, 0, 2, 2000);
  const VisibilityIndex index(screen);
  RayVisibility visibility(index);
  EXPECT_NEAR(visibility.visible_fraction(light, floor, 4096, 1), expected, 0.05 * expected);
  EXPECT_LT(expected, 0.1);
}

TEST(Exchange, ClosureErrorShrinksWithTheNumberOfRays) {
  const MeshedRoom room(test::l_room(true), 0.35);
  const auto error = [&](int rays) {
    return room.exchange({.rays_per_pair = rays, .closure = Closure::leave})
        .report.closure_error_rms;
  };
  const double few = error(4), many = error(64);
  EXPECT_LT(many, few / 3);
  EXPECT_GT(few, 0);
}

TEST(Exchange, OpenScenesAreRecognised) {
  Scene open = unit_room();
  open.faces.pop_back();
  const Exchange exchange = MeshedRoom(open, 0.5).exchange();
  EXPECT_FALSE(exchange.report.closed);
  EXPECT_FALSE(exchange.report.closure_enforced);
  EXPECT_NEAR(exchange.report.escaping_fraction, 0.2, 1e-4);
  Scene inside_out = unit_room();
  std::reverse(inside_out.faces[5].vertices.begin(), inside_out.faces[5].vertices.end());
  EXPECT_FALSE(MeshedRoom(inside_out, 0.5).exchange().report.closed);
}

TEST(Exchange, DoesNotDependOnTheNumberOfThreads) {
  const MeshedRoom room(test::l_room(true), 0.5);
  Exchange one, many;
  tbb::task_arena(1).execute([&] { one = room.exchange(); });
  tbb::task_arena(2).execute([&] { many = room.exchange(); });
  ASSERT_EQ(one.matrix.nonZeros(), many.matrix.nonZeros());
  for (Eigen::Index k = 0; k < one.matrix.nonZeros(); ++k)
    ASSERT_EQ(one.matrix.valuePtr()[k], many.matrix.valuePtr()[k]);
}

TEST(Exchange, StopsWhenAsked) {
  const MeshedRoom cube(unit_room(), 0.3);
  std::stop_source stop;
  stop.request_stop();
  const Exchange exchange = cube.exchange({}, {stop.get_token(), {}});
  EXPECT_FALSE(exchange.report.complete);
  EXPECT_FALSE(exchange.report.closure_enforced);
}

TEST(Exchange, RefusesWhatDoesNotFit) {
  MeshedRoom cube(unit_room(), 1);
  const ElementTable& few = cube.elements;
  try {
    ElementTable many;
    many.corners.resize(200000, few.corners[0]);
    for (int e = 0; e < 200000; ++e) many.surface.push_back(e % 6);
    compute_exchange(cube.scene, many, VisibilityIndex(occluders(cube.scene)));
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::too_large);
  }
  EXPECT_THROW(cube.exchange({.tolerance = 0}), Error);
  EXPECT_THROW(cube.exchange({.rays_per_pair = 0}), Error);
}

}  // namespace
}  // namespace halfshade
