#include "solver/adapt/adaptive_field.h"
#include "tests/support/fitted_functions.h"
#include "tests/support/mesh_invariants.h"
#include "tests/support/random.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace halfshade {
namespace {

using test::field_of;
using test::Function;
using test::mesh_of;
using test::true_error;

/// The unit square in z = 0 with elements along the line y = 3 x − 1.
SoundScene merged_square() {
  SoundScene scene = test::empty_sound_scene(std::sqrt(2.));
  test::add_surface(scene, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 0);
  Surface& surface = scene.surfaces[0];
  surface.contacts.push_back(
      {surface.frame.to_plane({1. / 3, 0, 0}), surface.frame.to_plane({2. / 3, 1, 0})});
  return scene;
}

bool is_right_of_line(const Vec3& p) { return p.y() < 3 * p.x() - 1; }

std::vector<int> all_of(const PatchMesh& mesh) {
  std::vector<int> all(at(mesh.element_count()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

TEST(MergedField, PolynomialsStayExactThroughRoundsOfSplittingAndMerging) {
  test::Random random(12);
  const SoundScene scene = merged_square();
  PatchMesh mesh = mesh_of(scene, 0.5);
  const int least = mesh.element_count();
  int gone = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<int> some;
    for (int i = random.integer(4, 30); i > 0; --i)
      some.push_back(random.below(mesh.element_count()));
    round % 2 == 0 ? mesh.bisect(some) : mesh.split_in_four(some);
    some.clear();
    for (int e = 0; e < mesh.element_count(); ++e)
      if (random.below(4) > 0) some.push_back(e);
    const int before = mesh.element_count();
    mesh.merge(some);
    gone += before - mesh.element_count();
    test::expect_sound(mesh.elements(), scene);
    const int order = round % (max_order + 1);
    const double a = random(-1, 1), b = random(-1, 1);
    // On each side of the line another one.
    const Function f = [&](const Vec3& p) {
      return 2 + std::pow(a * p.x() + b * p.y(), order) + (is_right_of_line(p) ? 1 : 0);
    };
    AdaptiveFieldOptions options;
    options.tolerance = 1e6;
    options.order = order;
    options.split = false;
    const AdaptiveField fit = fit_adaptively(mesh, field_of(f), options);
    EXPECT_LT(true_error(fit, f), 1e-13) << order;
    EXPECT_LT(fit.report.relative_error, 1e-12) << order;
    EXPECT_NEAR(std::accumulate(fit.elements.area.begin(), fit.elements.area.end(), 0.), 1, 1e-12);
    if (round % 5 > 0) continue;
    // What is one polynomial on each side takes hardly any splits.
    options = {};
    options.tolerance = 1e-9;
    options.merge = true;
    const AdaptiveField merged = fit_adaptively(mesh, field_of(f), options);
    EXPECT_LE(merged.elements.count(), least + (fit.elements.count() - least) / 4);
    EXPECT_LE(true_error(merged, f), 1e-9);
  }
  EXPECT_GT(gone, 20);
}

struct MergedCase {
  const char* name;
  double (*f)(const Vec3&);
};

class MergedFieldAccuracy : public testing::TestWithParam<MergedCase> {};

TEST_P(MergedFieldAccuracy, WhatIsSmallerThanItNeedsBeIsMergedAndStaysRight) {
  const auto f = GetParam().f;
  for (const int order : {-1, 2})
    for (const double tolerance : {1e-2, 1e-4}) {
      const SoundScene scene = merged_square();
      AdaptiveFieldOptions options;
      options.tolerance = tolerance;
      options.order = order;
      PatchMesh mesh = mesh_of(scene, 0), other = mesh_of(scene, 0);
      for (PatchMesh* both : {&mesh, &other})
        for (int k = 0; k < 9; ++k) both->bisect(all_of(*both));
      const AdaptiveField fine = fit_adaptively(other, field_of(f), options);
      options.merge = true;
      const AdaptiveField merged = fit_adaptively(mesh, field_of(f), options);
      EXPECT_EQ(merged.report.limit, FieldLimit::none);
      EXPECT_EQ(merged.elements.count(), mesh.element_count());
      test::expect_sound(mesh.elements(), scene);
      EXPECT_LT(merged.elements.count(), 0.7 * fine.elements.count()) << order;
      EXPECT_LT(static_cast<double>(merged.report.unknowns),
                0.8 * static_cast<double>(fine.report.unknowns))
          << order;
      const double actual = true_error(merged, f, 3);
      EXPECT_LE(merged.report.relative_error, tolerance);
      EXPECT_LE(actual, tolerance) << order;
      EXPECT_GE(merged.report.relative_error, 0.9 * actual) << order;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Functions, MergedFieldAccuracy,
    testing::Values(MergedCase{"smooth",
                               [](const Vec3& p) {
                                 return 1 + std::exp(p.x() - 0.7 * p.y()) * std::sin(2 * p.y());
                               }},
                    MergedCase{"broken_at_the_line",
                               [](const Vec3& p) {
                                 return 1 + std::sin(2 * p.y()) + (is_right_of_line(p) ? 1 : 0);
                               }},
                    MergedCase{
                        "kinked_elsewhere",
                        [](const Vec3& p) { return 1 + std::abs(p.x() + 0.3 * p.y() - 0.95); }}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace halfshade
