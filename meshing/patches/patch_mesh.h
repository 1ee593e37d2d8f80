#pragma once

#include "meshing/core/progress.h"
#include "meshing/patches/element_table.h"
#include "meshing/triangulation/curve_mesh.h"
#include "meshing/triangulation/planar_mesh.h"

#include <memory>
#include <span>
#include <vector>

namespace halfshade {

class SharedEdges;

/// The present elements, which are the leaves, and all that they are parts of.
struct PatchHierarchy {
  std::vector<int> parent;   ///< node → node; −1 at roots
  std::vector<int> level;    ///< node → number of ancestors
  std::vector<int> element;  ///< node → present element, −1 for inner nodes
};

/// The adaptive element mesh over all surfaces of a scene. Invariant: the mesh of each surface is
/// conforming (no T-vertices), covers it, and has an edge chain along every contact line. Where
/// surfaces share an edge, or an edge lies on another as a contact line, both are subdivided
/// alike, and stay so.
class PatchMesh {
 public:
  /// Meshes every surface with `options`, in parallel. Throws Error(too_large) if more than
  /// `options.max_triangles` elements come out in all. If `progress` is stopped, surfaces not yet
  /// reached are left coarse.
  PatchMesh(const SoundScene& scene, const PlanarMeshOptions& options,
            const Progress& progress = {});

  /// Takes the mesh of each surface as it is, one an entry; `shared` is of the same scene.
  /// `curve_order[id]` is the order of the discontinuity curve with that id.
  PatchMesh(const SoundScene& scene, const SharedEdges& shared, std::span<const CurveMesh> meshes,
            std::span<const int> curve_order);
  ~PatchMesh();
  PatchMesh(PatchMesh&&) noexcept;
  PatchMesh& operator=(PatchMesh&&) noexcept;

  int element_count() const;

  /// The present elements in a deterministic order: by surface, then in order of creation.
  ElementTable elements() const;

  PatchHierarchy hierarchy() const;

  /// Corners of a node that has parts, in the order that its element would have.
  std::array<Vec3, 3> triangle(int node) const;

  /// Splits each named element into four at its edge midpoints. Neighbours are split as far as it
  /// takes to stay conforming: an element with a split edge also has its longest edge split
  /// (red–green–blue refinement; Carstensen 2004), which keeps angles bounded below for any number
  /// of calls.
  void split_in_four(std::span<const int> elements);

  /// Bisects each named element at its longest edge, with the same closure (Rivara 1984).
  void bisect(std::span<const int> elements);

  /// Undoes splits: where all parts of an element are named, and those of all others that got
  /// points on common edges with it, also on other surfaces, the wholes take their places. Returns
  /// node of the hierarchy before → node now, −1 for parts that are gone.
  std::vector<int> merge(std::span<const int> elements);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Longest edge that gives about `element_count` elements over the whole scene.
double length_for_count(const SoundScene& scene, int element_count);

}  // namespace halfshade
