#include "solver/pipeline/direct_meshes.h"

#include "meshing/core/error.h"
#include "solver/pipeline/solve_mesh.h"

#include <utility>

namespace halfshade {
namespace {

/// Of the elements that there may be, this share may be there before any is divided.
constexpr double share_at_first = 0.5;
/// Between curves that meet at small angles good ones take many elements: where narrow ones are
/// fewer than this share, they do, for each takes but few more unknowns.
constexpr double narrow_angle = 1, much_fewer = 0.8;

/// Not quite as narrow as surfaces are, if that can be, for parts of needles are needles.
PatchMesh mesh_for_adaptation(const SoundScene& scene, const SolveOptions& options, bool few,
                              const Progress& progress) {
  PlanarMeshOptions mesh_options;
  mesh_options.max_triangles =
      static_cast<std::size_t>(share_at_first * static_cast<double>(options.max_elements));
  for (const double angle : {least_angle_of_direct, 3., 1.}) {
    if (few && angle == least_angle_of_direct) continue;
    mesh_options.min_angle = angle;
    try {
      return PatchMesh(scene, mesh_options, progress);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::too_large) throw;
    }
  }
  mesh_options.min_angle = 0;
  mesh_options.max_triangles = static_cast<std::size_t>(options.max_elements);
  return mesh_plainly(scene, mesh_options, options, progress);
}

std::optional<DiscontinuityMesh> try_along(const SoundScene& scene, const Discontinuities& curves,
                                           const DiscontinuityMeshOptions& options,
                                           const Progress& progress) {
  try {
    return mesh_discontinuities(scene, curves, options, progress);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::too_large) throw;
    return std::nullopt;
  }
}

}  // namespace

double length_of_elements(const SoundScene& scene, const SolveOptions& options) {
  if (options.refine == Refinement::adaptive) return 0;
  return options.max_length > 0 ? options.max_length : length_for_count(scene, options.elements);
}

bool has_budget(const SolveOptions& options) {
  return options.refine == Refinement::uniform && options.max_length == 0;
}

PatchMesh mesh_without_curves(const SoundScene& scene, const SolveOptions& options, bool few,
                              const Progress& progress) {
  if (has_budget(options))
    return *std::move(make_solve_mesh(scene, options, progress, least_angle_of_direct).patches);
  if (options.refine == Refinement::adaptive)
    return mesh_for_adaptation(scene, options, few, progress);
  PlanarMeshOptions mesh_options;
  mesh_options.max_length = length_of_elements(scene, options);
  mesh_options.min_angle = least_angle_of_direct;
  mesh_options.max_triangles = static_cast<std::size_t>(options.max_elements);
  return mesh_plainly(scene, mesh_options, options, progress);
}

std::optional<DiscontinuityMesh> mesh_along_curves(const SoundScene& scene,
                                                   const Discontinuities& curves,
                                                   const DiscontinuityMeshOptions& options,
                                                   bool may_be_narrow, const Progress& progress) {
  std::optional<DiscontinuityMesh> mesh = try_along(scene, curves, options, progress);
  if (!may_be_narrow) return mesh;
  DiscontinuityMeshOptions narrow_options = options;
  narrow_options.min_angle = narrow_angle;
  std::optional<DiscontinuityMesh> narrow = try_along(scene, curves, narrow_options, progress);
  if (narrow &&
      (!mesh || narrow->patches.element_count() < much_fewer * mesh->patches.element_count()))
    mesh = std::move(narrow);
  return mesh;
}

}  // namespace halfshade
