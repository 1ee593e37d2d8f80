#include "solver/adapt/adaptive_field.h"
#include "tests/support/fields_on_square.h"
#include "tests/support/fitted_functions.h"

#include <gtest/gtest.h>

#include <span>

// Where the fit ends for another reason than that it is good enough.

namespace halfshade {
namespace {

using test::field_of;
using test::fixed;
using test::jumping;
using test::kinked;
using test::mesh_of;
using test::square;
using test::true_error;

/// What it reports of a jump within limits that are too narrow for it.
void expect_limit(const AdaptiveFieldOptions& options, FieldLimit limit) {
  const SoundScene scene = square();
  PatchMesh mesh = mesh_of(scene, 0.3);
  const AdaptiveField fit = fit_adaptively(mesh, field_of(jumping), options);
  EXPECT_EQ(fit.report.limit, limit);
  EXPECT_EQ(fit.elements.count(), mesh.element_count());
  EXPECT_GT(fit.report.relative_error, options.tolerance);
  const double actual = true_error(fit, jumping, 8);
  EXPECT_GE(fit.report.relative_error, 0.8 * actual);
  EXPECT_LE(fit.report.relative_error, 3 * actual);
  // What it takes to stay conforming is known afterwards only.
  EXPECT_LE(fit.elements.count(), 1.1 * options.max_elements);
  EXPECT_LE(static_cast<double>(fit.report.unknowns), 1.3 * options.max_unknowns);
}

TEST(AdaptiveFieldLimits, AreToldAndTheEstimateHolds) {
  AdaptiveFieldOptions options;
  options.tolerance = 1e-4;
  options.max_elements = 300;
  expect_limit(options, FieldLimit::elements);
  options = {};
  options.tolerance = 1e-4;
  options.max_unknowns = 2000;
  expect_limit(options, FieldLimit::unknowns);
  options = {};
  options.tolerance = 1e-4;
  options.samples_of_other_way = 10000;
  expect_limit(options, FieldLimit::samples);
  for (const int order : {-1, 0, 2, 8}) {
    options = fixed(order);
    options.tolerance = 1e-4;
    expect_limit(options, FieldLimit::fixed);
  }
}

TEST(AdaptiveFieldLimits, NoOtherWayIsTakenForWhichTooFewSamplesAreLeft) {
  const SoundScene scene = square();
  PatchMesh mesh = mesh_of(scene, 0);
  AdaptiveFieldOptions options;
  options.tolerance = 1e-4;
  options.samples_of_other_way = 10000;
  options.samples_left = [] { return 30000.; };
  options.max_elements = 2000;
  EXPECT_NE(fit_adaptively(mesh, field_of(kinked), options).report.limit, FieldLimit::samples);
}

TEST(AdaptiveFieldLimits, AsManySamplesAreTakenAsThereMayBe) {
  for (const double for_one : {5., 20., 200.}) {
    const SoundScene scene = square();
    PatchMesh mesh = mesh_of(scene, 0.1);
    const double most = for_one * mesh.element_count();
    double taken = 0;
    const FieldAt inner = field_of(jumping);
    const FieldAt field = [&](std::span<const FieldPoint> points, const Progress& progress) {
      taken += static_cast<double>(points.size());
      return inner(points, progress);
    };
    AdaptiveFieldOptions options;
    options.tolerance = 1e-6;
    options.samples_left = [&] { return most - taken; };
    const AdaptiveField fit = fit_adaptively(mesh, field, options);
    EXPECT_EQ(fit.report.limit, FieldLimit::work);
    EXPECT_LE(taken, 1.2 * most) << for_one;
    EXPECT_GE(taken, 0.7 * most) << for_one;
    const double error = true_error(fit, jumping, 4);
    EXPECT_LE(error, for_one < 10 ? 0.1 : 0.05);
    EXPECT_LE(error, 1.2 * fit.report.relative_error) << for_one;
  }
}

}  // namespace
}  // namespace halfshade
