#pragma once

#include "meshing/backprojection/visible_part.h"
#include "meshing/discontinuity/discontinuity.h"
#include "meshing/discontinuity/search_budget.h"
#include "meshing/events/emitter_scene.h"

#include <cstddef>
#include <vector>

namespace halfshade {

/// Finds what no swath makes: curves in the emitter's plane, and jumps along contact lines. Keeps
/// buffers between calls; one a thread.
class BorderSearch {
 public:
  /// All must outlive the search.
  BorderSearch(const SoundScene& scene, const OpaqueScene& opaque,
               const EmitterScene& emitter_scene);

  /// Where a receiver crosses the emitter's plane and sees the emitter edge-on: before it the
  /// irradiance grows from zero. Appends straight curves of order 1. Ends early and returns false
  /// if its looks at the emitter take more than `most_work`.
  bool add_plane_curves(int receiver, double most_work, std::vector<DiscontinuityCurve>& curves);

  /// The contact lines of a receiver at which the irradiance from the emitter jumps. Appends
  /// straight curves of order 0. Ends early and returns false as above.
  bool add_contact_curves(int receiver, double most_work, std::vector<DiscontinuityCurve>& curves);

  /// So many points it takes, for each stretch of a receiver in the emitter's plane, to know which
  /// of them limit the view.
  std::size_t limit_tests() const { return limits_.size() * emitter_scene_.corners.size(); }

  /// All that looks took so far.
  const SightEffort& effort() const { return finder_.effort(); }

 private:
  const VisiblePart& look(const Vec3& point, const Surface& receiver);

  const SoundScene& scene_;
  const EmitterScene& emitter_scene_;
  std::vector<Vec2> limits_;  ///< of the emitter's plane, that can limit what is seen along it
  VisiblePartFinder finder_;
  VisiblePart part_;
};

}  // namespace halfshade
