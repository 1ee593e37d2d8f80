#pragma once

#include "meshing/backprojection/visible_part.h"
#include "meshing/discontinuity/discontinuity.h"
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
  /// if it takes more than `most_looks` looks at the emitter.
  bool add_plane_curves(int receiver, std::size_t most_looks,
                        std::vector<DiscontinuityCurve>& curves);

  /// The contact lines of a receiver at which the irradiance from the emitter jumps. Appends
  /// straight curves of order 0. Ends early and returns false as above.
  bool add_contact_curves(int receiver, std::size_t most_looks,
                          std::vector<DiscontinuityCurve>& curves);

  /// So many times the emitter was looked at so far.
  std::size_t looks() const { return looks_; }

 private:
  const VisiblePart& look(const Vec3& point, const Surface& receiver);

  const SoundScene& scene_;
  const EmitterScene& emitter_scene_;
  std::vector<Vec3> limits_;  ///< of the emitter's plane, that can limit what is seen along it
  VisiblePartFinder finder_;
  VisiblePart part_;
  std::size_t looks_ = 0;
};

}  // namespace halfshade
