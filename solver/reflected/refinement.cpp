#include "solver/reflected/refinement.h"

#include "meshing/core/rounded.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

// Of the goal, elements may have this share and are refined to have a little less.
constexpr double share_of_elements = 0.55, aim_of_elements = 0.3;
/// Elements that are off by so many times their part are bisected twice, by its square thrice.
constexpr double far_too_much = 16;
constexpr int most_bisections = 4;
/// The share of an element's error that bisecting it takes away, beside edges.
constexpr double gain = 0.5;
constexpr double most_scale = 4;
/// How much the coefficients of the highest degree count beside what was found at points.
constexpr double share_of_tails = 0.75;
/// Of the sum: the deviation of an estimate in which no few points say most.
constexpr double usual_deviation = 0.1;

/// ∫ |error|² without what a few points say, if that is most of it: it may be theirs alone, and the
/// next estimate tells.
double surely_off(const ReflectionEstimate& estimate) {
  return estimate.sum - std::max(0., estimate.deviation - usual_deviation * estimate.sum);
}

/// ∫ |error|² of each, `all` in all, without noise of rays.
std::vector<double> errors_of_elements(const RefinementInput& input, double all) {
  std::vector<double> result = tails(input.mesh, input.irradiance, input.weight);
  std::vector<double> known(result.size(), 0);
  for (std::size_t e = 0; e < result.size(); ++e)
    if (const double found = input.estimate.square_error[e]; found != 0)
      known[e] = (1 - share_of_tails) * (input.estimate.chance[e] * found - input.noise[e]);
  const double sum = summed(result), rest = all - summed(known);
  const double scale = sum > 0 ? std::clamp(rest / sum, 0., most_scale) : 0;
  for (std::size_t e = 0; e < result.size(); ++e) result[e] = scale * result[e] + known[e];
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
      plan.times.push_back(2);
    }
}

/// Of an element that is off by so many times its part.
int bisections(double too_much) {
  const double more = std::log(std::max(too_much, 1.)) / std::log(far_too_much);
  return 1 + static_cast<int>(std::min(more, most_bisections - 1.));
}

}  // namespace

double summed(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.);
}

std::vector<double> element_weights(const ReflectedMesh& mesh, const FirstLight& light,
                                    const ErrorWeight& weight) {
  std::vector<double> weights;
  for (int e = 0; e < mesh.count(); ++e)
    weights.push_back(mean_weight(weight, light.surface[at(mesh.root(e))],
                                  mesh.forest.corners(mesh.triangle[at(e)])));
  return weights;
}

std::vector<double> tails(const ReflectedMesh& mesh, const ElementField& field,
                          const std::vector<double>& weight) {
  std::vector<double> result;
  double steep = 0, all = 0;  // of elements of order 1
  for (int e = 0; e < mesh.count(); ++e) {
    const int p = field.order[at(e)];
    const double share = mesh.area(e) * weight[at(e)];
    result.push_back(share * field.of(e).bottomRows(p + 1).square().sum());
    if (p != 1) continue;
    steep += result.back();
    all += share * field.of(e).square().sum();
  }
  for (int e = 0; e < mesh.count(); ++e)
    if (field.order[at(e)] == 0) result[at(e)] *= all > 0 ? steep / all : 0;
  return result;
}

RefinementPlan plan_refinement(const RefinementInput& input, double goal) {
  RefinementPlan plan;
  const double noise = summed(input.noise);
  double left = surely_off(input.estimate) - noise;
  const std::vector<double> coarse = errors_of_elements(input, left);
  std::vector<int> order(coarse.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return rounded(coarse[at(a)]) > rounded(coarse[at(b)]); });
  int counted = 0;
  for (int e = 0; e < input.mesh.count(); ++e) counted += input.mesh.counts(e) ? 1 : 0;
  const double part = aim_of_elements * goal / std::max(counted, 1);
  if (left > share_of_elements * goal)
    for (const int e : order) {
      if (left <= aim_of_elements * goal || coarse[at(e)] <= part) break;
      left -= gain * coarse[at(e)];
      plan.elements.push_back(e);
      plan.times.push_back(bisections(coarse[at(e)] / part));
    }
  if (input.balance.square > share_of_elements * goal) add_unsure(input.balance, plan);
  return plan;
}

}  // namespace halfshade
