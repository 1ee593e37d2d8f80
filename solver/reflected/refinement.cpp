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
constexpr double most_at_once = 16;
/// Noise of stratified rays falls faster than their number rises.
constexpr double noise_exponent = 1.2;

}  // namespace

RefinementPlan plan_refinement(const ReflectedMesh& mesh, const ReflectionEstimate& estimate,
                               const std::vector<double>& noise, double goal) {
  RefinementPlan plan;
  const double all_noise = std::accumulate(noise.begin(), noise.end(), 0.);
  if (all_noise > share_of_noise * goal)
    plan.more_rays = std::clamp(std::pow(all_noise / (aim_of_noise * goal), 1 / noise_exponent),
                                1.5, most_at_once);
  std::vector<double> coarse(estimate.square_error);
  for (std::size_t e = 0; e < coarse.size(); ++e)
    if (coarse[e] != 0) coarse[e] -= noise[e];
  double left = estimate.sum - all_noise;
  std::vector<int> order(coarse.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return coarse[at(a)] > coarse[at(b)]; });
  const double part = aim_of_elements * goal / mesh.count();
  if (left > share_of_elements * goal)
    for (const int e : order) {
      if (left <= aim_of_elements * goal || coarse[at(e)] <= part) break;
      left -= coarse[at(e)];
      plan.elements.push_back(e);
      plan.twice.push_back(coarse[at(e)] > far_too_much * part);
    }
  // The estimate itself is too uncertain: it becomes surer with more rays.
  if (plan.elements.empty() && plan.more_rays == 1) plan.more_rays = 2;
  return plan;
}

}  // namespace halfshade
