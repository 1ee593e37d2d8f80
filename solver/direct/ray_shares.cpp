#include "solver/direct/ray_shares.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {
namespace {

/// The variance of the visible share is this over the number of rays to the power of 3/2: an edge
/// of a shadow cuts as many of the rays' cells as lie along it. With few rays that is above the 1/4
/// of independent ones. Two halves of them, each spread on its own, do somewhat worse than all.
constexpr double variance_of_rays = 0.7, power_of_rays = 1.5;
/// A ray that is drawn tells yes or no of its share of the light: that has a variance of 1/4 at
/// most. But rays of their own are noisy only where an emitter is partly hidden, and drawn ones
/// wherever some emitters are hidden and others not. To be preferred they have to be so much
/// better.
constexpr double variance_of_drawn = 1;
/// With n = each s^power rays for what gives s, no other numbers of them do with fewer.
constexpr double power_of_share = 2 / (power_of_rays + 1);
/// Emitters are drawn if weaker than a power of two, from the first to the last of so many.
constexpr int steps = 48, first_exponent = -36;
/// Rays for all that are drawn.
constexpr double most_drawn = 1e6;

/// Sums over emitters: what decides how many rays they take.
struct Strengths {
  double own = 0;    ///< of powers of those with rays of their own
  double drawn = 0;  ///< of those that are drawn
};

/// How many rays make the variances sum to one.
struct Numbers {
  double each = 0;   ///< times the power of an emitter's strength: its own
  double drawn = 0;  ///< for all that are drawn
};

/// With the multiplier λ of the condition each = (1.5 · .7 λ)^.4 and drawn = √λ · strength;
/// x = λ^−.1 is the root of a polynomial b x⁶ + d x⁵ = 1 that rises and bends upwards.
Numbers numbers_for(const Strengths& sum) {
  if (!(sum.own > 0 || sum.drawn > 0)) return {};
  constexpr double slope = power_of_rays * variance_of_rays;
  const double b = variance_of_rays * sum.own / std::pow(slope, power_of_rays * power_of_share / 2);
  const double d = std::sqrt(variance_of_drawn) * sum.drawn;
  double x = b > 0 ? std::pow(b, -1. / 6) : std::pow(d, -1. / 5);
  if (b > 0 && d > 0) x = std::min(x, std::pow(d, -1. / 5));
  constexpr int newton_steps = 6;  // from above; x is right to rounding, or nearly so
  for (int k = 0; k < newton_steps; ++k) {
    const double x4 = x * x * x * x;
    x -= (b * x4 * x * x + d * x4 * x - 1) / (6 * b * x4 * x + 5 * d * x4);
  }
  const double root = 1 / (x * x * x * x);  // λ^.4
  return {std::pow(slope, power_of_share / 2) * root, d * root / x};
}

double power_of(const RayShare& share) { return std::pow(share.strength, power_of_share); }

/// Those that rays of their own would take too many for are looked at exactly.
Strengths look_at_strongest(std::span<RayShare> shares, double most_rays) {
  Strengths sum;
  for (const RayShare& share : shares) {
    if (share.way == RayWay::own) sum.own += power_of(share);
    if (share.way == RayWay::drawn) sum.drawn += share.strength;
  }
  while (sum.own > 0) {
    RayShare* strongest = nullptr;
    for (RayShare& share : shares)
      if (share.way == RayWay::own && (!strongest || share.strength > strongest->strength))
        strongest = &share;
    if (!strongest) break;
    const double power = power_of(*strongest);
    if (std::ceil(numbers_for(sum).each * power) <= most_rays) break;
    strongest->way = RayWay::exact;
    sum.own = std::max(sum.own - power, 0.);
  }
  return sum;
}

int step_of(const RayShare& share) {
  return std::clamp(std::ilogb(share.strength) - first_exponent, 0, steps - 1);
}

/// Emitters with rays of their own about as strong as each other.
struct Step {
  int count = 0;
  double powers = 0, strengths = 0;
};

/// How many rays are taken in all: two for an emitter at least, and half of them rounded up.
double rays_taken(std::span<const Step> own, const Numbers& numbers) {
  double rays = numbers.drawn > 0 ? std::max(numbers.drawn + 1, 2.) : 0;
  for (const Step& step : own)
    rays += std::max(numbers.each * step.powers + step.count, 2. * step.count);
  return rays;
}

/// Draws the weak ones, if that takes fewer rays.
Strengths draw_weak(std::span<RayShare> shares, Strengths sum) {
  std::array<Step, steps> by_step{};
  for (const RayShare& share : shares) {
    if (share.way != RayWay::own) continue;
    Step& step = by_step[static_cast<std::size_t>(step_of(share))];
    ++step.count;
    step.powers += power_of(share);
    step.strengths += share.strength;
  }
  Strengths best = sum;
  double fewest = rays_taken(by_step, numbers_for(sum));
  int drawn = 0;  // steps
  for (int k = 0; k < steps; ++k) {
    const Step& step = by_step[static_cast<std::size_t>(k)];
    if (step.count == 0) continue;
    sum.own = std::max(sum.own - step.powers, 0.);
    sum.drawn += step.strengths;
    const auto stronger = std::span(by_step).subspan(static_cast<std::size_t>(k) + 1);
    const double rays = rays_taken(stronger, numbers_for(sum));
    if (rays >= fewest) continue;
    fewest = rays;
    best = sum;
    drawn = k + 1;
  }
  for (RayShare& share : shares)
    if (share.way == RayWay::own && step_of(share) < drawn) share.way = RayWay::drawn;
  return best;
}

/// Of each of two estimates.
int half_of(double rays) { return std::max(static_cast<int>(std::ceil(rays / 2)), 1); }

}  // namespace

DrawnRays share_rays(std::span<RayShare> shares, double most_rays) {
  const Numbers numbers = numbers_for(draw_weak(shares, look_at_strongest(shares, most_rays)));
  DrawnRays drawn;
  for (RayShare& share : shares) {
    if (share.way == RayWay::drawn) drawn.strength += share.strength;
    if (share.way != RayWay::own) continue;
    const double rays = std::ceil(numbers.each * power_of(share));
    if (rays > most_rays)
      share.way = RayWay::exact;
    else
      share.rays = half_of(rays);
  }
  if (drawn.strength > 0) drawn.rays = half_of(std::min(numbers.drawn, most_drawn));
  return drawn;
}

}  // namespace halfshade
