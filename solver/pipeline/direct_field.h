#pragma once

#include "meshing/patches/discontinuity_mesh.h"
#include "solver/adapt/adaptive_field.h"
#include "solver/pipeline/goal.h"
#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve_options.h"

#include <memory>
#include <vector>

namespace halfshade {

/// Direct light on elements made for it, and how they came about.
struct DirectField {
  std::shared_ptr<PatchMesh> patches;  ///< as the elements are
  AdaptiveField light;
  std::vector<Region> region;  ///< of each element, with respect to the strongest emitter
  DiscontinuityReport discontinuities;
  std::size_t curves = 0;              ///< found, after merging
  DiscontinuityMeshReport mesh;        ///< how many of them elements have edges along
  double discontinuity_tolerance = 0;  ///< share of the mean irradiance; 0 without curves
  std::vector<Warning> warnings;
};

/// Exact direct light as polynomials, to options.tolerance in the L2 norm if elements are refined.
/// First without curves, unless they are forced: until that is likely to take more samples than
/// finding curves and following them would, which a part of their search has told, or more elements
/// or unknowns than there may be. Then along curves; if neither way gets there, that which comes
/// closer is kept. With a goal the tolerance is that of what the error does to it. Adds its stages
/// to `stages`.
DirectField find_direct_field(const PreparedScene& prepared, const Plan& plan,
                              const SolveOptions& options, const Progress& progress, Stages& stages,
                              const GoalWeights* goal = nullptr);

/// What `options` and a goal, if any, say of a field on elements.
AdaptiveFieldOptions field_options(const SoundScene& scene, const Plan& plan,
                                   const SolveOptions& options, const GoalWeights* goal = nullptr);

/// No light on elements that are as large as the surfaces allow: where direct light is found like
/// reflected light.
DirectField no_direct_field(const SoundScene& scene, const SolveOptions& options,
                            const Progress& progress, Stages& stages);

}  // namespace halfshade
