#pragma once

#include "solver/reflected/balance_estimate.h"
#include "solver/reflected/final_pass.h"
#include "solver/reflected/reflection_estimate.h"

#include <vector>

namespace halfshade {

/// Which elements to refine so that the next estimate meets a goal, if noise has its part.
struct RefinementPlan {
  std::vector<int> elements;
  std::vector<int> times;  ///< one an entry of `elements`: how often it and its parts are bisected
};

/// What is known of a solution that is not yet right.
struct RefinementInput {
  const ReflectedMesh& mesh;
  const ElementField& irradiance;
  const std::vector<double>& noise;   ///< of rays, see noise_of_elements; it has been filtered
  const std::vector<double>& weight;  ///< see element_weights
  const ReflectionEstimate& estimate;
  const BalanceEstimate& balance;
};

/// Of square errors of each element.
std::vector<double> element_weights(const ReflectedMesh& mesh, const FirstLight& light,
                                    const ErrorWeight& weight);

/// The share of a field's square in the polynomials of the highest degree on each element,
/// weighted: where it is large elements are likely to be too coarse. Constants are taken to be off
/// by as much as those of order 1 are steep.
std::vector<double> tails(const ReflectedMesh& mesh, const ElementField& field,
                          const std::vector<double>& weight);

/// `goal` is the ∫ |error|² allowed. The estimate knows how large the error of all elements is, but
/// of each only by a point or two, if any: a quarter of the error is laid where it was found, as
/// far as what a point finds is the element's own, the rest where the coefficients of the highest
/// degree are large. Where it is the balance of power that is not known, those that know least.
RefinementPlan plan_refinement(const RefinementInput& input, double goal);

/// Of all elements.
double summed(const std::vector<double>& values);

}  // namespace halfshade
