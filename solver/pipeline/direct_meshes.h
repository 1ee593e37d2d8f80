#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "solver/pipeline/solve_options.h"

#include <optional>

namespace halfshade {

/// Degrees: of direct light's elements. Polynomials do well on elements that are too narrow for
/// constants.
inline constexpr double least_angle_of_direct = 10;

/// Longest edge of elements that are not divided, scene units; 0 where they are.
double length_of_elements(const SoundScene& scene, const SolveOptions& options);

/// Whether elements are not divided, and there are to be so many.
bool has_budget(const SolveOptions& options);

/// Elements for direct light that follow no curves. Those that are to be divided are narrow where
/// narrow surfaces would take too many others, and somewhat so if `few` are asked for.
/// Error(too_large): see mesh_plainly.
PatchMesh mesh_without_curves(const SoundScene& scene, const SolveOptions& options, bool few,
                              const Progress& progress);

/// Elements that follow curves; nothing if that takes too many. If they `may_be_narrow`, they are
/// where curves meet at small angles and good ones would take many more.
std::optional<DiscontinuityMesh> mesh_along_curves(const SoundScene& scene,
                                                   const Discontinuities& curves,
                                                   const DiscontinuityMeshOptions& options,
                                                   bool may_be_narrow, const Progress& progress);

}  // namespace halfshade
