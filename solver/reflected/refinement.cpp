#include "solver/reflected/refinement.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

// Of the goal, rays may have this share and are sent for a little less; elements likewise.
constexpr double share_of_noise = 0.4, aim_of_noise = 0.3;
constexpr double share_of_elements = 0.4, aim_of_elements = 0.2;
/// Elements that are off by more than this many times their part are bisected twice.
constexpr double far_too_much = 16;
/// The share of an element's error that bisecting it takes away, beside edges.
constexpr double gain = 0.7;
constexpr double most_at_once = 16;
/// Elements first where they are the larger part of the error: more rays cost more with each round.
constexpr double most_if_coarse = 2;
/// Noise of stratified rays falls faster than their number rises.
constexpr double noise_exponent = 1.2;

/// Share of the field in the polynomials of the highest degree, less what is noise of it.
std::vector<double> tails(const RefinementInput& input) {
  std::vector<double> result;
  for (int e = 0; e < input.mesh.count(); ++e) {
    const int p = input.irradiance.order[at(e)];
    const double square = input.irradiance.of(e).bottomRows(p + 1).square().sum();
    const double noise = input.noise[at(e)] * (p + 1) / basis_size(p);
    result.push_back(
        p == 0 ? 0 : std::max(0., input.mesh.area(e) * input.weight[at(e)] * square - noise));
  }
  return result;
}

/// ∫ |error|² of each, `all` in all, without noise of rays.
std::vector<double> errors_of_elements(const RefinementInput& input, double all) {
  std::vector<double> result = tails(input);
  const double sum = std::accumulate(result.begin(), result.end(), 0.);
  const double scale = sum > 0 ? std::clamp(all / sum, 0., 1.) : 0;
  for (std::size_t e = 0; e < result.size(); ++e) {
    const double found = input.estimate.square_error[e];
    result[e] = 0.5 * scale * result[e] + 0.5 * (found != 0 ? found - input.noise[e] : 0);
  }
  return result;
}

/// Adds the elements that know least of what gets lost.
void add_unsure(const BalanceEstimate& balance, RefinementPlan& plan) {
  const std::vector<double>& unsure = balance.of_element;
  std::vector<bool> is_in(unsure.size(), false);
  for (const int e : plan.elements) is_in[at(e)] = true;
  for (int e = 0; e < static_cast<int>(unsure.size()); ++e)
    if (!is_in[at(e)] && unsure[at(e)] > 0) {
      plan.elements.push_back(e);
      plan.twice.push_back(true);
    }
}

}  // namespace

RefinementPlan plan_refinement(const RefinementInput& input, double goal) {
  RefinementPlan plan;
  const double noise = std::accumulate(input.noise.begin(), input.noise.end(), 0.);
  double left = input.estimate.sum - noise;
  if (noise > share_of_noise * goal)
    plan.more_rays = std::clamp(std::pow(noise / (aim_of_noise * goal), 1 / noise_exponent), 1.5,
                                left > goal ? most_if_coarse : most_at_once);
  const std::vector<double> coarse = errors_of_elements(input, left);
  std::vector<int> order(coarse.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return coarse[at(a)] > coarse[at(b)]; });
  const double part = aim_of_elements * goal / input.mesh.count();
  if (left > share_of_elements * goal)
    for (const int e : order) {
      if (left <= aim_of_elements * goal || coarse[at(e)] <= part) break;
      left -= gain * coarse[at(e)];
      plan.elements.push_back(e);
      plan.twice.push_back(coarse[at(e)] > far_too_much * part);
    }
  if (input.balance.square > share_of_elements * goal) add_unsure(input.balance, plan);
  // The estimate itself is too uncertain: it becomes surer with more rays.
  if (plan.elements.empty() && plan.more_rays == 1) plan.more_rays = 2;
  return plan;
}

}  // namespace halfshade
