#pragma once

#include "meshing/patches/patch_mesh.h"
#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"
#include "solver/pipeline/solve_light.h"
#include "solver/pipeline/solve_options.h"

namespace halfshade {

/// What constant elements became.
struct SubdividedLight {
  ElementTable elements;
  SolvedLight light;
  SubdivisionReport report;
};

/// The elements from which the irradiance (mean of the channels) changes by more than `step` to a
/// neighbour, or to which it does; sorted. Nothing changes across curves of order 0.
std::vector<int> steep_elements(const ElementTable& elements, const ChannelArray& irradiance,
                                double step);

/// Adaptive subdivision as it began (Cohen, Greenberg, Immel and Brock 1986): elements where the
/// irradiance is steep are split in four, as often as the options say; those there were at first
/// are the patches, which go on sending light. Light on all elements is found anew after each
/// round, see solve_two_levels. `light` is that of the patches, the elements of `mesh`. Adds its
/// stages to `stages`. If stopped, the last round is left out. Throws Error(too_large) if it takes
/// more than options.max_elements.
SubdividedLight subdivide(const PreparedScene& prepared, const Plan& plan,
                          const SolveOptions& options, PatchMesh mesh, SolvedLight light,
                          const Progress& progress, Stages& stages);

}  // namespace halfshade
