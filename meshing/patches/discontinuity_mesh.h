#pragma once

#include "meshing/discontinuity/discontinuity.h"
#include "meshing/patches/patch_mesh.h"

#include <vector>

namespace halfshade {

struct DiscontinuityMeshOptions {
  double max_length = 0;  ///< no element edge longer than this, scene units; 0: no limit
  double min_angle = delaunay_angle;  ///< degrees, in [0, delaunay_angle]
  std::size_t max_triangles = 4000000;
  /// Curves whose damage J_k h^k / k! stays below this irradiance (W/m²) for elements of size h
  /// are left out, and curves are flattened so that the misplacement stays below it. 0: complete.
  double irradiance_tolerance = 0;
  /// How far chords may be off the conics they stand for, as a share of the surface, below 1; 0:
  /// what the tolerance allows, or 1e-4 without one.
  double deviation = 0;
};

struct DiscontinuityMeshReport {
  std::size_t kept = 0, culled = 0;     ///< curves
  double deviation = 0;                 ///< largest distance of a mesh edge from its curve
  int boundary_rounds = 0;              ///< until shared borders agreed
  std::size_t unfinished_surfaces = 0;  ///< refinement ended early
};

/// A patch mesh with element edges along discontinuity curves.
struct DiscontinuityMesh {
  PatchMesh patches;
  DiscontinuityMeshReport report;
};

/// Meshes every surface with edges along the curves that lie in it. Where surfaces share an edge
/// (or one's edge lies on another as a contact line) their elements share its subdivision: no
/// T-vertices anywhere.
DiscontinuityMesh mesh_discontinuities(const SoundScene& scene, const Discontinuities& found,
                                       const DiscontinuityMeshOptions& options,
                                       const Progress& progress = {});

/// What each element sees of each source at a point inside it: row-major, one row an element, one
/// column a source. In the complete mesh that holds for the whole element. On all threads.
std::vector<Region> label_elements(const SoundScene& scene, const OpaqueScene& opaque,
                                   const ElementTable& elements,
                                   std::span<const LightSource> sources,
                                   const Progress& progress = {});

/// The same for the elements of a complete mesh of these sources: what the widest element of each
/// cell sees, all of the cell do. Some more of large cells are looked at, and all of them where
/// those do not agree.
std::vector<Region> label_cells(const SoundScene& scene, const OpaqueScene& opaque,
                                const ElementTable& elements, std::span<const LightSource> sources,
                                const Progress& progress = {});

}  // namespace halfshade
