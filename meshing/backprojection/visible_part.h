#pragma once

#include "meshing/backprojection/edge_id.h"
#include "meshing/backprojection/opaque_scene.h"
#include "meshing/backprojection/sight_effort.h"
#include "meshing/core/sound_scene.h"
#include "meshing/core/types.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace halfshade {

struct SightCandidates;

/// What a point sees of an emitter.
enum class Region : std::uint8_t {
  lit,       ///< all of the part above its horizon
  penumbra,  ///< some of it
  umbra,     ///< nothing, because of occluders
  away       ///< nothing, because the emitter lies below the horizon or faces away
};

/// A directed straight piece of the boundary of the visible part. Seen from the point, the visible
/// part lies on its left.
struct BoundaryPiece {
  Vec3 from, to;  ///< end points in the direction of the boundary, on the edge that makes it
  EdgeId edge;    ///< the edge it lies on
};

struct VisiblePart {
  Region region = Region::away;
  /// Closed chains, one after the other, each in the order of its boundary; empty in umbra and
  /// away. Consecutive pieces meet in a direction, each with a point on its own edge.
  std::vector<BoundaryPiece> pieces;
  std::vector<int> chain_ends;  ///< for each chain, where the next one starts in `pieces`
  /// The boundary of the whole part above the horizon, the same as `pieces` if lit; empty if away.
  std::vector<BoundaryPiece> unobstructed;
  /// Hash of which edges and vertices of emitter and occluders bound the visible part, and how they
  /// follow each other; equal for all points of one cell of the complete discontinuity mesh.
  std::uint64_t signature = 0;
};

/// Finds visible parts. Keeps its buffers between calls, so that in the steady state of a batch
/// nothing is allocated; one a thread.
class VisiblePartFinder {
 public:
  /// `scene` must outlive the finder.
  explicit VisiblePartFinder(const OpaqueScene& scene);
  ~VisiblePartFinder();
  VisiblePartFinder(VisiblePartFinder&&) noexcept;
  VisiblePartFinder& operator=(VisiblePartFinder&&) noexcept;

  /// The visible part of emitter `surface` (an id of SoundScene::surfaces, with holes and
  /// non-convex if it is) from `point` above the horizon given by the unit `normal`. Every opaque
  /// polygon blocks from both sides, except that whatever lies in the emitter's plane or only
  /// touches the line of sight at its ends does not. Decided by exact predicates with symbolic
  /// tie-breaking; end points are correct to rounding. Cost grows with the number of silhouette
  /// edges between point and emitter.
  void find(const Vec3& point, const Vec3& normal, int surface, VisiblePart& part);

  /// Its region alone. Some directions often tell that it is in penumbra, in far less time.
  Region region(const Vec3& point, const Vec3& normal, int surface);

  /// What find does, or false, with nothing found, where so many edges cross in the view of the
  /// emitter that find_in_cells is quicker.
  bool find_unless_crowded(const Vec3& point, const Vec3& normal, int surface, VisiblePart& part);

  /// The same, with the same bits, where it is known what may come between the point and the
  /// emitter.
  bool find_unless_crowded(const Vec3& point, const Vec3& normal, int surface,
                           const SightCandidates& candidates, VisiblePart& part);

  /// What may come between the emitter and any of the points, out of `among` if that is not
  /// nullptr: it must be known to hold it.
  void find_candidates(std::span<const Vec3> points, int surface, const SightCandidates* among,
                       SightCandidates& found);

  /// Calls `use` with the visible part of each of the triangles into which the emitter is cut for
  /// it, in a fixed order; those away are left out. Returns how much was looked at, in faces and
  /// crossings; the same whatever was asked before. Triangles that one face hides are done at once,
  /// and the others are cut until few faces are left to look at: the cost is that of what the eye
  /// meets first, not of all that lies behind it. Signatures mean nothing, and edges of triangles
  /// count as the emitter's.
  std::size_t find_in_cells(const Vec3& point, const Vec3& normal, int surface, VisiblePart& part,
                            const std::function<void(const VisiblePart&)>& use);

  /// All that was done so far. A look that is repeated because of contradictions counts again.
  const SightEffort& effort() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The visible part as polygons in the emitter's plane: rings with the visible part on their left
/// seen from the point, pieces joined and projected onto the plane.
std::vector<std::vector<Vec3>> visible_rings(const VisiblePart& part, const Vec3& point,
                                             const PlaneFrame& emitter);

}  // namespace halfshade
