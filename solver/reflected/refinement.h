#pragma once

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

/// `goal` is the ∫ |error|² allowed.
RefinementPlan plan_refinement(const ReflectedMesh& mesh, const ReflectionEstimate& estimate,
                               const std::vector<double>& noise, double goal);

}  // namespace halfshade
