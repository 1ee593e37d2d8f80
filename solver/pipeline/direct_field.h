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
/// First without curves, unless they are forced: with as many samples as finding curves would cost.
/// Only if those do not get there are curves looked for, and the work is at most twice that of the
/// better way. With a goal the tolerance is that of what the error does to it. Adds its stages to
/// `stages`.
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
