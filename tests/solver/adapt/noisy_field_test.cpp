#include "solver/adapt/noisy_field.h"

#include "meshing/geometry/mix_bits.h"
#include "tests/support/expect_error.h"
#include "tests/support/fitted_functions.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <stop_token>

namespace halfshade {
namespace {

using test::Function;
using test::in_channels;
using test::true_error;

constexpr double uniform_deviation = 0.28867513459481287;  // of numbers from 0 to 1

/// Of a place, from −√3 to √3, so that its deviation is 1.
double noise_at(const Vec3& p, std::uint64_t which) {
  std::uint64_t bits = which;
  for (int k = 0; k < 3; ++k) bits = mix_bits(bits ^ std::bit_cast<std::uint64_t>(p[k]));
  return (unit_share(bits) - 0.5) / uniform_deviation;
}

/// With so much noise in the mean of two values.
NoisyFieldAt noisy_field_of(const Function& f, double deviation) {
  return [=](std::span<const FieldPoint> points, std::span<const double>, const Progress&) {
    std::vector<NoisyValue> values;
    for (const FieldPoint& point : points) {
      const Vec3& p = point.point.position;
      const double noise = std::sqrt(2.) * deviation;
      values.push_back(
          {in_channels(f(p) + noise * noise_at(p, 1)), in_channels(f(p) + noise * noise_at(p, 2))});
    }
    return values;
  };
}

PatchMesh unit_square(double max_length) {
  SoundScene scene = test::empty_sound_scene(std::sqrt(2.));
  test::add_surface(scene, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 0);
  PlanarMeshOptions options;
  options.max_length = max_length;
  return PatchMesh(scene, options);
}

double one(const FieldPoint&) { return 1; }

double waves(const Vec3& p) { return 1 + std::sin(5 * p.x()) * std::cos(4 * p.y()); }
double step(const Vec3& p) { return p.x() + 0.37 * p.y() < 0.613 ? 1 : 0.2; }
/// A shadow with a soft border, and a spot.
double shadows(const Vec3& p) {
  const double edge = std::clamp((p.x() - 0.4 - 0.2 * p.y()) / 0.15, 0., 1.);
  return 0.1 + edge + std::exp(-300 * ((p - Vec3(0.2, 0.7, 0)).squaredNorm()));
}

TEST(NoisyField, IsAsExactAsItSays) {
  int within_three = 0, runs = 0;
  for (const Function& f : {Function(waves), Function(step), Function(shadows)})
    for (const double tolerance : {0.1, 0.05, 0.02})
      for (const double noise : {0., 0.5, 1.}) {
        PatchMesh mesh = unit_square(0.3);
        AdaptiveFieldOptions options;
        options.tolerance = tolerance;
        const AdaptiveField fit =
            fit_noisy(mesh, noisy_field_of(f, noise * tolerance), one, options);
        ASSERT_EQ(fit.report.limit, FieldLimit::none);
        EXPECT_TRUE(fit.report.is_noisy);
        EXPECT_LE(fit.report.relative_error, tolerance);
        const double off = true_error(fit, f, 3);
        EXPECT_LE(off, tolerance) << noise;
        EXPECT_LE(off, 1.15 * fit.report.relative_error) << tolerance << ' ' << noise;
        within_three += 3 * off > fit.report.relative_error;
        ++runs;
      }
  EXPECT_GT(within_three, 0.8 * runs);
}

TEST(NoisyField, TakesFewSamplesWhereLittleCanBe) {
  const Function f = [](const Vec3& p) { return p.x() < 0.1 ? 1 + p.y() : 1e-4 * p.y(); };
  const auto samples = [&](const FieldBound& bound) {
    PatchMesh mesh = unit_square(0.02);
    AdaptiveFieldOptions options;
    options.tolerance = 0.1;
    return fit_noisy(mesh, noisy_field_of(f, 0.01), bound, options).report.samples;
  };
  const std::size_t few = samples([&](const FieldPoint& p) { return f(p.point.position); });
  EXPECT_LT(4 * few, 3 * samples(one));
}

TEST(NoisyField, AllowsSmallElementsMoreNoise) {
  // Half of it in small elements, and many more of them than large ones.
  SoundScene scene = test::empty_sound_scene(std::sqrt(2.));
  test::add_surface(scene, {{{0, 0, 0}, {0.5, 0, 0}, {0.5, 1, 0}, {0, 1, 0}}}, 0);
  constexpr int rows = 20;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < 2 * rows; ++j) {
      constexpr double width = 0.5 / rows;
      const double x = 0.5 + width * i, y = width * j;
      test::add_surface(
          scene, {{{x, y, 0}, {x + width, y, 0}, {x + width, y + width, 0}, {x, y + width, 0}}}, 0);
    }
  AdaptiveFieldOptions options;
  options.tolerance = 0.05;
  double most = 0, least = 1e9;
  std::size_t allowed = 0, all = 0;
  const NoisyFieldAt noisier = [&](std::span<const FieldPoint> points,
                                   std::span<const double> slack, const Progress& progress) {
    std::vector<NoisyValue> values;
    for (std::size_t k = 0; k < points.size(); ++k) {
      values.push_back(
          noisy_field_of(waves, 0.1 * slack[k])(points.subspan(k, 1), {}, progress)[0]);
      (points[k].surface == 0 ? least : most) =
          points[k].surface == 0 ? std::min(least, slack[k]) : std::max(most, slack[k]);
      allowed += slack[k] > 1;
    }
    all += points.size();
    return values;
  };
  PatchMesh mesh(scene, {});
  const AdaptiveField fit = fit_noisy(mesh, noisier, one, options);
  EXPECT_EQ(least, 1);
  EXPECT_GT(most, 1.1);
  EXPECT_LT(most, 4);
  EXPECT_GT(allowed, all / 10);
  EXPECT_LE(fit.report.relative_error, options.tolerance);
  EXPECT_LE(true_error(fit, waves), 1.15 * fit.report.relative_error);
}

/// Or light in small elements would never be as exact as the tolerance.
TEST(NoisyField, AllowsPartsOfElementsNoMoreNoise) {
  double first = 0, later = 0;
  const NoisyFieldAt noisier = [&](std::span<const FieldPoint> points,
                                   std::span<const double> slack, const Progress& progress) {
    (first == 0 ? first : later) = std::max(later, *std::ranges::max_element(slack));
    return noisy_field_of(step, 0.01)(points, {}, progress);
  };
  AdaptiveFieldOptions options;
  options.tolerance = 0.02;
  PatchMesh mesh = unit_square(0.3);
  const AdaptiveField fit = fit_noisy(mesh, noisier, one, options);
  const auto [least, most] = std::ranges::minmax(fit.elements.area);
  EXPECT_LT(least, 0.01 * most);
  EXPECT_LT(later, 1.5 * first);
}

/// Of single elements only that is known which noise did not make.
TEST(NoisyField, ElementsTogetherAreOffByWhatAllAre) {
  // The second is even but for a spot that only places which are compared have met.
  const Function spot = [](const Vec3& p) {
    return (p - Vec3(0.52, 0.43, 0)).norm() < 0.015 ? 20 : 1;
  };
  for (const auto& [f, noise] : {std::pair(Function(shadows), 0.05), std::pair(spot, 0.)}) {
    PatchMesh mesh = unit_square(0.1);
    AdaptiveFieldOptions options;
    options.tolerance = 0.05;
    if (noise == 0) options.samples_left = [] { return 0.; };
    const AdaptiveField fit = fit_noisy(mesh, noisy_field_of(f, noise), one, options);
    double error = 0, norm = 0;
    for (int e = 0; e < fit.field.count(); ++e) {
      error += fit.elements.area[at(e)] * std::pow(fit.error[e], 2);
      norm += fit.elements.area[at(e)] * fit.field.of(e).matrix().squaredNorm();
    }
    EXPECT_GT(fit.report.relative_error, 0.01);
    EXPECT_NEAR(std::sqrt(error / norm), fit.report.relative_error,
                1e-9 * fit.report.relative_error);
  }
}

/// A few places with a spot that elements do not know of may say anything.
TEST(NoisyField, LooksAtMorePlacesWhereFewSayTooLittle) {
  const auto samples = [](double height) {
    const Function f = [=](const Vec3& p) {
      return 1 + height * std::exp(-2e4 * (p - Vec3(0.52, 0.43, 0)).squaredNorm());
    };
    PatchMesh mesh = unit_square(0.3);
    AdaptiveFieldOptions options;
    options.tolerance = 0.02;
    options.samples_left = [] { return 0.; };
    return fit_noisy(mesh, noisy_field_of(f, 0.01), one, options).report.samples;
  };
  EXPECT_LT(samples(0), 12000u);
  EXPECT_GT(samples(20), 20000u);
}

/// A small surface and a large one, each evenly lit: noise may grow with the norm over the mean.
TEST(NoisyField, AllowsMoreNoiseWhereAFewPlacesCarryTheNorm) {
  SoundScene scene = test::empty_sound_scene(2.);
  test::add_surface(scene, {{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}}, 0);
  test::add_surface(scene, {{{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}}, 0);
  AdaptiveFieldOptions options;
  options.tolerance = 0.01;
  for (const double hot : {1., 30., 100.}) {
    const Function f = [=](const Vec3& p) { return p.x() < 0.5 ? hot : 1; };
    std::vector<double> least;  // of the large surface, by call
    const NoisyFieldAt noisier = [&](std::span<const FieldPoint> points,
                                     std::span<const double> slack, const Progress& progress) {
      least.push_back(1e9);
      std::vector<NoisyValue> values;
      for (std::size_t k = 0; k < points.size(); ++k) {
        values.push_back(noisy_field_of(f, 0.02 * slack[k])(points.subspan(k, 1), {}, progress)[0]);
        if (points[k].surface == 1) least.back() = std::min(least.back(), slack[k]);
      }
      return values;
    };
    PatchMesh mesh(scene, {});
    const AdaptiveField fit = fit_noisy(mesh, noisier, one, options);
    const double small = 0.01, all = 1 + small;
    const double norm = std::sqrt((1 + small * hot * hot) / all), mean = (1 + small * hot) / all;
    ASSERT_GE(least.size(), 2u);
    EXPECT_EQ(least.front(), 1) << hot;
    EXPECT_NEAR(least.back(), norm / mean, 0.05 * norm / mean) << hot;
    EXPECT_LE(fit.report.relative_error, options.tolerance) << hot;
    EXPECT_LE(true_error(fit, f), 1.15 * fit.report.relative_error) << hot;
  }
}

/// Very many elements of which a few carry the norm: their first samples may be as noisy as suits
/// it.
TEST(NoisyField, KnowsOfPeaksBeforeManyElementsAreSampled) {
  PatchMesh mesh = unit_square(0.015);
  ASSERT_GT(mesh.element_count(), 5000);
  const Function f = [](const Vec3& p) { return p.x() < 0.02 && p.y() < 0.5 ? 30 : 1; };
  AdaptiveFieldOptions options;
  options.tolerance = 0.1;
  std::vector<std::pair<std::size_t, double>> calls;  // how many places, and the least slack
  const NoisyFieldAt noisier = [&](std::span<const FieldPoint> points,
                                   std::span<const double> slack, const Progress& progress) {
    calls.emplace_back(points.size(), *std::ranges::min_element(slack));
    return noisy_field_of(f, 0.1 * slack[0])(points, {}, progress);
  };
  const AdaptiveField fit = fit_noisy(
      mesh, noisier, [&](const FieldPoint& p) { return f(p.point.position); }, options);
  const double norm = std::sqrt(0.99 + 0.01 * 900), mean = 0.99 + 0.01 * 30;
  ASSERT_GE(calls.size(), 2u);
  EXPECT_LT(calls[0].first, calls[1].first / 5);
  EXPECT_NEAR(calls[1].second, norm / mean, 0.1 * norm / mean);
  EXPECT_LE(true_error(fit, f), 1.15 * fit.report.relative_error);
}

/// Less noise than the tolerance lets samples have, as where most rays tell the same: they may be
/// told to have more, until it is half of the square of the error, or six times as large.
TEST(NoisyField, AllowsMoreNoiseWhereThereIsLittle) {
  AdaptiveFieldOptions options;
  options.tolerance = 0.05;
  for (const auto& [noise, width] :
       {std::pair(0.02, 0.1), {0.02, 0.015}, {0.05, 0.1}, {1e-3, 0.1}, {0., 0.1}}) {
    PatchMesh mesh = unit_square(width);
    std::vector<double> least;  // slack, by call
    const NoisyFieldAt noisier = [&, usual = noise](std::span<const FieldPoint> points,
                                                    std::span<const double> slack,
                                                    const Progress& progress) {
      least.push_back(*std::ranges::min_element(slack));
      return noisy_field_of(shadows, usual * least.back())(points, {}, progress);
    };
    const AdaptiveField fit = fit_noisy(mesh, noisier, one, options);
    double norm = 0;
    Rgb mean = Rgb::Zero();
    for (int e = 0; e < fit.field.count(); ++e) {
      norm += fit.elements.area[at(e)] * fit.field.of(e).matrix().squaredNorm();
      mean += fit.elements.area[at(e)] * fit.field.of(e).row(0).transpose();
    }
    const double peaks = std::sqrt(norm / mean.square().sum());
    norm /= in_channels(1).square().sum();
    const double most = noise > 0 ? std::sqrt(0.5 * norm) * options.tolerance / noise : HUGE_VAL;
    EXPECT_NEAR(least.back(), std::clamp(most, peaks, 6 * peaks), 0.1 * least.back()) << noise;
    EXPECT_LE(fit.report.relative_error, options.tolerance) << noise;
    EXPECT_LE(true_error(fit, shadows), 1.15 * fit.report.relative_error) << noise;
  }
}

/// Polynomials through a few samples across the edge of a shadow fall below 0 beside it, and would
/// be drawn black.
TEST(NoisyField, IsNoisierWhereItsFirstRoundWouldTakeTooMuch) {
  constexpr double deviation = 0.02, dear = 4e-4, rays_for_noise = 4. / 3;
  double work = 0, places = 0;
  const NoisyFieldAt field = [&](std::span<const FieldPoint> points, std::span<const double> slack,
                                 const Progress& progress) {
    std::vector<NoisyValue> values;
    for (std::size_t k = 0; k < points.size(); ++k) {
      values.push_back(
          noisy_field_of(waves, deviation * slack[k])(points.subspan(k, 1), {}, progress)[0]);
      work += dear * std::pow(slack[k], -rays_for_noise);
    }
    places += static_cast<double>(points.size());
    return values;
  };
  PatchMesh mesh = unit_square(0.02);
  ASSERT_GT(2 * mesh.elements().count() * dear, 4) << "two samples each take far too much";
  AdaptiveFieldOptions options;
  options.tolerance = 1e-3;
  options.work_done = [&] { return work; };
  options.samples_left = [&] { return work > 0 ? (1 / work - 1) * places : HUGE_VAL; };
  const AdaptiveField fit = fit_noisy(mesh, field, one, options);
  EXPECT_EQ(fit.report.limit, FieldLimit::work);
  EXPECT_LT(work, 1.5);
  EXPECT_GT(fit.report.relative_error, options.tolerance);
  EXPECT_LE(true_error(fit, waves, 3), fit.report.relative_error);
  EXPECT_LE(fit.report.relative_error, 3 * true_error(fit, waves, 3));
}

TEST(NoisyField, LightIsNotBelowZeroAtNodes) {
  const Function dark = [](const Vec3& p) { return p.x() + 0.37 * p.y() < 0.613 ? 1 : 0; };
  PatchMesh mesh = unit_square(0.2);
  AdaptiveFieldOptions options;
  options.tolerance = 0.05;
  const AdaptiveField fit = fit_noisy(mesh, noisy_field_of(dark, 0), one, options);
  int varying = 0;
  for (int e = 0; e < fit.field.count(); ++e) {
    varying += fit.field.of(e).rows() > 1;
    for (const TrianglePlace& place : element_nodes(2))
      EXPECT_GE(value_at(fit.field, e, place).minCoeff(), -1e-12) << e;
  }
  EXPECT_GT(varying, 5);
  EXPECT_LE(true_error(fit, dark), 1.15 * fit.report.relative_error);
}

TEST(NoisyField, SaysWhenALimitStopsIt) {
  PatchMesh mesh = unit_square(0.2);
  AdaptiveFieldOptions options;
  options.tolerance = 0.01;
  options.max_elements = 2 * mesh.element_count();
  const AdaptiveField fit = fit_noisy(mesh, noisy_field_of(step, 0.01), one, options);
  EXPECT_EQ(fit.report.limit, FieldLimit::elements);
  EXPECT_GT(fit.report.relative_error, 0.01);
  EXPECT_LE(fit.elements.count(), 1.3 * options.max_elements);
  EXPECT_LE(true_error(fit, step, 3), 1.15 * fit.report.relative_error);
}

TEST(NoisyField, EndsWhenItIsStopped) {
  PatchMesh mesh = unit_square(0.2);
  std::stop_source stop;
  stop.request_stop();
  AdaptiveFieldOptions options;
  const AdaptiveField fit =
      fit_noisy(mesh, noisy_field_of(waves, 0), one, options, {stop.get_token(), {}});
  EXPECT_EQ(fit.report.limit, FieldLimit::stopped);
  EXPECT_EQ(fit.field.count(), mesh.element_count());
}

TEST(NoisyField, IsTheSameInAnyUnit) {
  AdaptiveFieldOptions options;
  options.tolerance = 0.05;
  PatchMesh mesh = unit_square(0.3), other = unit_square(0.3);
  const AdaptiveField fit = fit_noisy(mesh, noisy_field_of(shadows, 0.02), one, options);
  const double unit = 0x1p500;
  const AdaptiveField strong = fit_noisy(
      other,
      [&](std::span<const FieldPoint> points, std::span<const double> slack,
          const Progress& progress) {
        auto values = noisy_field_of(shadows, 0.02)(points, slack, progress);
        for (NoisyValue& value : values) value = {unit * value.a, unit * value.b};
        return values;
      },
      one, options);
  ASSERT_EQ(strong.field.coefficients.rows(), fit.field.coefficients.rows());
  EXPECT_TRUE((strong.field.coefficients == unit * fit.field.coefficients).all());
}

TEST(NoisyField, IsDarkWhereAllIs) {
  PatchMesh mesh = unit_square(0.3);
  const AdaptiveField fit = fit_noisy(mesh, noisy_field_of([](const Vec3&) { return 0.; }, 0), one,
                                      AdaptiveFieldOptions{});
  EXPECT_EQ(fit.report.relative_error, 0);
  EXPECT_TRUE((fit.field.coefficients == 0).all());
}

TEST(NoisyField, RefusesWhatIsOutOfRange) {
  PatchMesh mesh = unit_square(0.3);
  AdaptiveFieldOptions options;
  options.tolerance = 0;
  test::expect_error([&] { fit_noisy(mesh, noisy_field_of(waves, 0), one, options); },
                     ErrorCode::contract, {"out of range"});
}

}  // namespace
}  // namespace halfshade
