#pragma once

#include "solver/reflected/balance_estimate.h"
#include "solver/reflected/final_pass.h"
#include "solver/reflected/reflection_estimate.h"

#include <vector>

namespace halfshade {

/// Which elements to refine, and how many rays to send, so that the next estimate meets a goal.
struct RefinementPlan {
  std::vector<int> elements;
  std::vector<bool> twice;  ///< one an entry of `elements`: far too coarse
  double more_rays = 1;     ///< factor for the number of rays from a node
};

/// What is known of a solution that is not yet right.
struct RefinementInput {
  const ReflectedMesh& mesh;
  const ElementField& irradiance;
  const std::vector<double>& noise;   ///< see FinalPass; weighted
  const std::vector<double>& weight;  ///< of square errors of each element
  const ReflectionEstimate& estimate;
  const BalanceEstimate& balance;
};

/// `goal` is the ∫ |error|² allowed. The estimate knows how large the error of all elements is, but
/// of each only by a point or two: half of the error is laid where it was found, half where the
/// coefficients of the highest degree are large. Where it is the balance of power that is not
/// known, those that know least.
RefinementPlan plan_refinement(const RefinementInput& input, double goal);

}  // namespace halfshade
