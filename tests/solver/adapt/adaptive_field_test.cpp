#include "solver/adapt/adaptive_field.h"

#include "tests/support/expect_error.h"
#include "tests/support/fields_on_square.h"
#include "tests/support/fitted_functions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stop_token>

namespace halfshade {
namespace {

using test::broken;
using test::field_of;
using test::fixed;
using test::Function;
using test::in_channels;
using test::jumping;
using test::kinked;
using test::mesh_of;
using test::near_singular;
using test::smooth;
using test::square;
using test::square_with_line;
using test::true_error;

/// Slope of log error over the log of the elements' size, by least squares over meshes.
double rate(const SoundScene& scene, const Function& f, int order, std::vector<double> lengths,
            int parts) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const double length : lengths) {
    PatchMesh mesh = mesh_of(scene, length);
    const AdaptiveField fit = fit_adaptively(mesh, field_of(f), fixed(order));
    EXPECT_EQ(fit.elements.count(), mesh.element_count());
    const double size = -0.5 * std::log(fit.elements.count());
    const double error = std::log(true_error(fit, f, parts));
    ++n, x += size, y += error, xx += size * size, xy += size * error;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

const std::vector<double> lengths = {0.4, 0.28, 0.2, 0.14, 0.1, 0.07, 0.05};

TEST(AdaptiveFieldRates, SmoothFunctionsConvergeByTheOrderPlusOne) {
  for (int p = 0; p <= 3; ++p) EXPECT_NEAR(rate(square(), smooth, p, lengths, 1), p + 1, 0.2) << p;
}

TEST(AdaptiveFieldRates, BreaksThatElementsDoNotFollowLimitThem) {
  // Without the coarsest meshes: which elements the line cuts there is a matter of chance.
  const std::vector<double> fine = {0.14, 0.1, 0.07, 0.05, 0.035};
  for (int k = 0; k <= 2; ++k)
    for (int p = 0; p <= 3; ++p)
      EXPECT_NEAR(rate(square(), broken(k), p, fine, k == 0 ? 3 : 2), std::min(p + 1., k + 0.5),
                  0.2)
          << k << ", " << p;
}

TEST(AdaptiveFieldRates, BreaksThatElementsFollowDoNot) {
  for (int k = 0; k <= 2; ++k)
    for (int p = 0; p <= 3; ++p)
      EXPECT_NEAR(rate(square_with_line(), broken(k), p, lengths, 1), p + 1, 0.2) << k << ", " << p;
}

struct Case {
  const char* name;
  double (*f)(const Vec3&);
  double least_tolerance;
  int parts;
  double least_ratio;  ///< of estimate and error
};

class AdaptiveFieldAccuracy : public testing::TestWithParam<Case> {};

TEST_P(AdaptiveFieldAccuracy, AskedIsGiven) {
  const auto& [name, f, least, parts, least_ratio] = GetParam();
  for (double tolerance = 1e-2; tolerance > 0.9 * least; tolerance /= 10) {
    const SoundScene scene = square();
    PatchMesh mesh = mesh_of(scene, 0);
    AdaptiveFieldOptions options;
    options.tolerance = tolerance;
    const AdaptiveField fit = fit_adaptively(mesh, field_of(f), options);
    ASSERT_EQ(fit.report.limit, FieldLimit::none) << tolerance;
    const double actual = true_error(fit, f, parts);
    EXPECT_LE(actual, tolerance);
    EXPECT_LE(fit.report.relative_error, tolerance);
    EXPECT_GE(fit.report.relative_error, least_ratio * actual) << tolerance;
    EXPECT_LE(fit.report.relative_error, 3 * actual) << tolerance;
    // What elements say of themselves is what the report says of all.
    double square = 0;
    for (int e = 0; e < fit.elements.count(); ++e)
      square += fit.elements.area[at(e)] * fit.error[e] * fit.error[e];
    EXPECT_NEAR(std::sqrt(square / square_integral(fit.field, fit.elements)),
                fit.report.relative_error, 1e-9 * tolerance);
    EXPECT_EQ(fit.report.unknowns, static_cast<std::size_t>(fit.field.first.back()));
  }
}

INSTANTIATE_TEST_SUITE_P(Functions, AdaptiveFieldAccuracy,
                         testing::Values(Case{"smooth", smooth, 1e-6, 1, 0.9},
                                         Case{"kinked", kinked, 1e-5, 3, 0.9},
                                         Case{"near_singular", near_singular, 1e-6, 2, 0.7},
                                         Case{"jumping", jumping, 1e-2, 6, 0.9}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(AdaptiveField, MetByFixedOrdersAndByChosenOnes) {
  for (int order = -1; order <= max_order; ++order) {
    const SoundScene scene = square();
    PatchMesh mesh = mesh_of(scene, 0.5);
    AdaptiveFieldOptions options;
    options.tolerance = order == 0 ? 2e-2 : 1e-3;
    options.order = order;
    const AdaptiveField fit = fit_adaptively(mesh, field_of(smooth), options);
    EXPECT_EQ(fit.report.limit, FieldLimit::none);
    EXPECT_LE(true_error(fit, smooth), options.tolerance);
    for (const int p : fit.field.order)
      if (order >= 0) {
        ASSERT_EQ(p, order);
      }
  }
}

TEST(AdaptiveField, TheHighestOrderIsKept) {
  for (int highest = 2; highest <= max_order; ++highest) {
    const SoundScene scene = square();
    PatchMesh mesh = mesh_of(scene, 0);
    AdaptiveFieldOptions options;
    options.tolerance = 1e-5;
    options.highest_order = highest;
    const AdaptiveField fit = fit_adaptively(mesh, field_of(smooth), options);
    EXPECT_LE(*std::max_element(fit.field.order.begin(), fit.field.order.end()), highest);
    EXPECT_LE(true_error(fit, smooth), options.tolerance);
  }
}

TEST(AdaptiveField, ToldOfAnotherNormItAllowsThatMuch) {
  const SoundScene scene = square();
  AdaptiveFieldOptions options;
  options.tolerance = 1e-3;
  PatchMesh mesh = mesh_of(scene, 0), other = mesh_of(scene, 0);
  const AdaptiveField strict = fit_adaptively(mesh, field_of(kinked), options);
  options.norm = 100 * std::sqrt(square_integral(strict.field, strict.elements));
  const AdaptiveField lax = fit_adaptively(other, field_of(kinked), options);
  EXPECT_LT(lax.report.unknowns, strict.report.unknowns);
  EXPECT_LE(true_error(lax, kinked, 3), 0.1);
}

TEST(AdaptiveField, LightOfAnySizeIsTheSame) {
  const auto fit_times = [](double factor) {
    const SoundScene scene = square();
    PatchMesh mesh = mesh_of(scene, 0);
    AdaptiveFieldOptions options;
    options.tolerance = 1e-3;
    return fit_adaptively(mesh, field_of([&](const Vec3& p) { return factor * kinked(p); }),
                          options);
  };
  const AdaptiveField one = fit_times(1);
  for (const double factor : {1e150, 1e-150}) {
    const AdaptiveField other = fit_times(factor);
    EXPECT_EQ(other.report.limit, FieldLimit::none);
    EXPECT_EQ(other.elements.corners, one.elements.corners) << factor;
    EXPECT_EQ(other.field.order, one.field.order) << factor;
    ASSERT_EQ(other.field.coefficients.rows(), one.field.coefficients.rows());
    EXPECT_LT((other.field.coefficients / factor - one.field.coefficients).abs().maxCoeff(), 1e-12);
    EXPECT_LT((other.error / factor - one.error).abs().maxCoeff(), 1e-12);
    EXPECT_NEAR(other.report.relative_error, one.report.relative_error, 1e-12);
  }
}

TEST(AdaptiveField, DarkIsExact) {
  const SoundScene scene = square();
  PatchMesh mesh = mesh_of(scene, 0);
  const AdaptiveField dark = fit_adaptively(mesh, field_of([](const Vec3&) { return 0.; }), {});
  EXPECT_EQ(dark.report.limit, FieldLimit::none);
  EXPECT_EQ(dark.report.relative_error, 0);
  EXPECT_TRUE((dark.field.coefficients == 0).all());
  EXPECT_TRUE((dark.error == 0).all());
  EXPECT_EQ(*std::max_element(dark.field.order.begin(), dark.field.order.end()), 0);
}

TEST(AdaptiveField, StoppedAnywhereItIsWhole) {
  double last_error = std::numeric_limits<double>::infinity();
  for (int calls = 1; calls <= 9; ++calls) {
    const SoundScene scene = square();
    PatchMesh mesh = mesh_of(scene, 0.5);
    std::stop_source stop;
    int called = 0;
    const FieldAt inner = field_of(kinked);
    const FieldAt field = [&](std::span<const FieldPoint> points, const Progress& progress) {
      if (++called == calls) stop.request_stop();
      std::vector<Rgb> values = inner(points, progress);
      if (called == calls)  // as fields do, in the middle
        std::fill(values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end(),
                  Rgb::Zero());
      return values;
    };
    AdaptiveFieldOptions options;
    options.tolerance = 1e-5;
    const AdaptiveField fit = fit_adaptively(mesh, field, options, {stop.get_token(), {}});
    EXPECT_EQ(called, calls);
    EXPECT_EQ(fit.report.limit, FieldLimit::stopped);
    ASSERT_EQ(fit.field.count(), fit.elements.count());
    ASSERT_EQ(fit.error.size(), fit.elements.count());
    EXPECT_EQ(fit.elements.count(), mesh.element_count());
    EXPECT_TRUE(fit.field.coefficients.allFinite());
    EXPECT_TRUE(fit.error.allFinite());
    EXPECT_NEAR(std::accumulate(fit.elements.area.begin(), fit.elements.area.end(), 0.), 1, 1e-12);
    for (int e = 0; e < fit.field.count(); ++e)
      ASSERT_EQ(fit.field.of(e).rows(), basis_size(fit.field.order[at(e)]));
    const double error = true_error(fit, kinked, 2);
    if (calls == 1) {
      EXPECT_EQ(error, 1) << "nothing is known yet";
    } else {
      EXPECT_LE(error, 1.001 * last_error) << "it keeps what it knew";
    }
    last_error = error;
  }
  EXPECT_LT(last_error, 0.02);
}

TEST(AdaptiveField, PolynomialsStayExactWhateverIsSplit) {
  test::Random random(11);
  const SoundScene scene = square();
  PatchMesh mesh = mesh_of(scene, 0);
  for (int round = 0; round < 20; ++round) {
    std::vector<int> some;
    for (int i = random.integer(1, 4); i > 0; --i)
      some.push_back(random.below(mesh.element_count()));
    if (round % 2 == 0)
      mesh.bisect(some);
    else
      mesh.split_in_four(some);
    const int order = round % (max_order + 1);
    const double a = random(-1, 1), b = random(-1, 1), c = random(0.5, 1);
    const Function f = [&](const Vec3& p) { return c + std::pow(a * p.x() + b * p.y(), order); };
    const AdaptiveField fit = fit_adaptively(mesh, field_of(f), fixed(order));
    EXPECT_EQ(fit.elements.count(), mesh.element_count());
    EXPECT_LT(true_error(fit, f), 1e-13) << order;
    EXPECT_LT(fit.report.relative_error, 1e-12) << order;
    EXPECT_NEAR(std::accumulate(fit.elements.area.begin(), fit.elements.area.end(), 0.), 1, 1e-12);
    if (order == 0) continue;
    // Orders that follow find out how much is needed.
    AdaptiveFieldOptions chosen;
    chosen.tolerance = 1e-9;
    chosen.split = false;
    const AdaptiveField found = fit_adaptively(mesh, field_of(f), chosen);
    EXPECT_EQ(found.report.limit, FieldLimit::none) << order;
    EXPECT_LE(true_error(found, f), 1e-9) << order;
    EXPECT_LE(*std::max_element(found.field.order.begin(), found.field.order.end()), order);
  }
}

TEST(AdaptiveField, TheNeighboursOfWhatIsSplitKeepTheirFits) {
  // Samples are taken for what is new only.
  const SoundScene scene = square();
  PatchMesh mesh = mesh_of(scene, 0.1);
  AdaptiveFieldOptions options;
  options.tolerance = 1e-3;
  options.order = 2;
  const Function spike = [](const Vec3& p) {
    return 1 + std::exp(-400 * (p - Vec3(0.3, 0.4, 0)).squaredNorm());
  };
  const AdaptiveField fit = fit_adaptively(mesh, field_of(spike), options);
  EXPECT_GT(fit.report.rounds, 2);
  EXPECT_LE(true_error(fit, spike, 2), options.tolerance);
  const auto an_element = static_cast<std::size_t>(9 + 4);
  EXPECT_LT(fit.report.samples, 2 * an_element * fit.elements.corners.size());
}

TEST(AdaptiveField, OptionsOutOfRangeAreRefused) {
  const auto expect_refused = [](const std::function<void(AdaptiveFieldOptions&)>& change) {
    const SoundScene scene = square();
    PatchMesh mesh = mesh_of(scene, 0);
    AdaptiveFieldOptions options;
    change(options);
    test::expect_error([&] { fit_adaptively(mesh, field_of(smooth), options); },
                       ErrorCode::contract, {"fit_adaptively"});
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double tolerance : {0., -1., infinity, std::nan("")})
    expect_refused([&](auto& options) { options.tolerance = tolerance; });
  for (const int order : {-2, max_order + 1})
    expect_refused([&](auto& options) { options.order = order; });
  for (const int order : {1, max_order + 1})
    expect_refused([&](auto& options) { options.highest_order = order; });
  for (const double norm : {-1., std::nan("")})
    expect_refused([&](auto& options) { options.norm = norm; });
  expect_refused([](auto& options) { options.max_elements = 0; });
  expect_refused([](auto& options) { options.max_unknowns = 0; });
}

}  // namespace
}  // namespace halfshade
