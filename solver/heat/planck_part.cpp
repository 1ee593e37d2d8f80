#include "solver/heat/planck_part.h"

#include <cmath>
#include <iterator>
#include <numbers>

namespace halfshade {
namespace {

/// hc/k in µm K, CODATA 2018.
constexpr double second_radiation_constant = 14387.768775039337;
/// 15/π⁴: what makes ∫ t³/(eᵗ − 1) from 0 to ∞ one.
constexpr double whole =
    15 / (std::numbers::pi * std::numbers::pi * std::numbers::pi * std::numbers::pi);

/// Below this the series of exponentials takes long, and the one of powers few terms.
constexpr double series_limit = 1;
/// Terms below this share of their sum are lost to rounding.
constexpr double negligible = 1e-18;
/// From here on e⁻ˣ is 0.
constexpr double nothing_beyond = 750;
/// In t = hc/λkT. Up to here Gauss's rule is exact to rounding, from here on differences are.
constexpr double narrow = 1;

/// 15/π⁴ ∫ from x to ∞ of t³/(eᵗ − 1): terms of e⁻ⁿˣ. x ≥ series_limit.
double share_beyond(double x) {
  if (!(x < nothing_beyond)) return 0;
  double sum = 0;
  for (int n = 1;; ++n) {
    const double term =
        std::exp(-n * x) * (((x + 3. / n) * x + 6. / (1. * n * n)) * x + 6. / (1. * n * n * n)) / n;
    sum += term;
    if (!(term > negligible * sum)) break;
  }
  return whole * sum;
}

/// The same from 0 to x: t³/(eᵗ − 1) = t² (1 − t/2 + Σ B_2k t^2k / (2k)!), term by term. x small.
double share_up_to(double x) {
  constexpr double coefficients[] = {1. / 12,           -1. / 720,
                                     1. / 30240,        -1. / 1209600,
                                     1. / 47900160,     -691. / 1307674368000,
                                     1. / 74724249600., -3617. / 10670622842880000.};
  double sum = 1. / 3 - x / 8, power = x * x;
  for (int k = 0; k < 8; ++k, power *= x * x) sum += coefficients[k] * power / (2 * k + 5);
  return whole * sum * x * x * x;
}

/// What the share below λ grows by with ln(λT), x = hc/λkT.
double density(double x) {
  return x < nothing_beyond && x > 0 ? whole * std::pow(x, 4) / std::expm1(x) : 0;
}

/// Gauss's rule of eight places: all is positive, so that nothing cancels.
PlanckPart narrow_part(double from, double width) {
  constexpr double places[] = {0.18343464249564980494, 0.52553240991632898582,
                               0.79666647741362673959, 0.96028985649753623168};
  constexpr double weights[] = {0.36268378337836198297, 0.31370664587788728734,
                                0.22238103445337447054, 0.10122853629037625915};
  PlanckPart part;
  for (std::size_t k = 0; k < std::size(places); ++k)
    for (const double side : {-1., 1.}) {
      const double t = from + width * (1 + side * places[k]) / 2;
      if (!(t > 0 && t < nothing_beyond)) continue;
      const double value = whole * t * t * (t / std::expm1(t)) * weights[k] / 2 * width;
      part.share += value;
      part.slope += value * (t / -std::expm1(-t));
    }
  return part;
}

}  // namespace

PlanckPart planck_part(double shortest, double longest, double temperature) {
  if (!(temperature > 0 && longest > shortest)) return {};
  const double scale = second_radiation_constant / temperature;
  const double from = scale / longest;
  const double width =
      scale / shortest * (std::isinf(longest) ? 1 : (longest - shortest) / longest);
  if (!(from < nothing_beyond)) return {};
  if (width <= narrow) return narrow_part(from, width);
  const double to = from + width;
  const double share = from < series_limit ? 1 - share_beyond(to) - share_up_to(from)
                                           : share_beyond(from) - share_beyond(to);
  return {share, 4 * share + density(from) - density(to)};
}

}  // namespace halfshade
