#pragma once

#include "meshing/patches/discontinuity_mesh.h"
#include "meshing/patches/patch_mesh.h"
#include "solver/pipeline/solve_options.h"

#include <optional>
#include <string>

namespace halfshade {

/// The elements that solve computes with.
struct SolveMesh {
  ElementTable elements;
  DiscontinuityMeshReport report;
  double tolerance = 0;               ///< share of the mean irradiance, as used
  std::optional<PatchMesh> patches;   ///< the same elements, for those who divide them
  double min_angle = delaunay_angle;  ///< of the elements, as used; degrees
};

/// How many elements surfaces and contact lines alone take at least.
std::size_t least_elements(const SoundScene& scene);

/// Throws Error(too_large) if surfaces and contact lines alone take more than options.max_elements.
void require_few_surfaces(const SoundScene& scene, const SolveOptions& options);

/// Elements that follow no curves. Throws Error(too_large) that names options.max_elements if they
/// are more than `mesh_options` allows.
PatchMesh mesh_plainly(const SoundScene& scene, const PlanarMeshOptions& mesh_options,
                       const SolveOptions& options, const Progress& progress);

/// The longest element edge that a mesh along curves may come to have.
double longest_edge(const SoundScene& scene, const SolveOptions& options);

/// Meshes with the length asked for, or with the one that takes the most elements that are no more
/// than asked for: narrow surfaces need more than their area suggests. Where there is none, with
/// smaller angles than `min_angle`, in degrees; where the geometry alone takes more, as few as can
/// be. Throws Error(too_large) if these are more than options.max_elements.
SolveMesh make_solve_mesh(const SoundScene& scene, const SolveOptions& options,
                          const Progress& progress = {}, double min_angle = delaunay_angle);

/// Why no curves need be looked for with a mesh without them that has so many elements: there are
/// none left for them. Empty if they do.
std::string no_elements_for_curves(int plain_elements, const SolveOptions& options);

/// The same along curves; `plain` is the mesh without them, and has the angle. Where they make more
/// than the elements asked for, or than `plain` if that has more, or more than
/// options.max_elements, those with the smallest effect are left out by raising the tolerance.
/// `mean_irradiance` is what options.tolerance is a share of; W/m².
SolveMesh make_solve_mesh(const SoundScene& scene, const Discontinuities& found, SolveMesh plain,
                          const SolveOptions& options, double mean_irradiance,
                          const Progress& progress = {});

}  // namespace halfshade
