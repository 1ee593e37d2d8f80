#pragma once

#include "meshing/discontinuity/event_jump.h"
#include "meshing/events/emitter_scene.h"

#include <vector>

namespace halfshade {

/// What is not worth following.
struct TraceLimits {
  double least_change = 0;  ///< of the form factor over an element; 0: everything is followed
  double max_length = 0;    ///< see element_size
};

/// Whether a line of a swath can be an event: it starts on the emitter, and the edges that must be
/// silhouettes may be. Decides for all lines between two neighbouring limits of the swath.
bool may_be_event(const EmitterScene& emitter_scene, const Swath& swath, const SightLine& line);

/// Says which events can matter, given what is not worth following.
class EventCulling {
 public:
  /// All but the limits must outlive the culling.
  EventCulling(const SoundScene& scene, const OpaqueScene& opaque,
               const EmitterScene& emitter_scene, const TraceLimits& limits);

  /// False only if what happens at a point of a receiver, where a line of the swath ends, is below
  /// the limits: by bounds for the jump over an element of the receiver.
  bool may_matter(const Swath& swath, const SightLine& line, int receiver,
                  const ReceivingPoint& at) const;

 private:
  bool factor_may_matter(const Vec3& point) const;
  bool slope_may_matter(const SightLine& line, const ReceivingPoint& at, double size) const;
  bool curvature_may_matter(const Swath& swath, const ReceivingPoint& at, double size) const;

  const OpaqueTopology& opaque_;
  const EmitterScene& emitter_scene_;
  TraceLimits limits_;
  std::vector<double> receiver_size_;  ///< see size_of
};

}  // namespace halfshade
