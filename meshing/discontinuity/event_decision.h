#pragma once

#include "meshing/backprojection/visible_part.h"
#include "meshing/discontinuity/event_evidence.h"
#include "meshing/discontinuity/event_jump.h"
#include "meshing/events/emitter_scene.h"

#include <span>

namespace halfshade {

/// Decides whether a curve runs through a point, by what is seen of the emitter on both sides of
/// it. Keeps its buffers between calls; one a thread.
class EventDecider {
 public:
  /// Both must outlive the decider.
  EventDecider(const OpaqueScene& opaque, const EmitterScene& emitter_scene);

  /// `step`: see side_step. How the places where edges of `group` (sorted) follow each other differ
  /// between the sides of a curve that would be normal to `at.across`, which is its left; triples
  /// sorted. Costs two or four visible parts.
  EventEvidence decide(const ReceivingPoint& at, double step, std::span<const EdgeId> group);

  const SightEffort& effort() const { return finder_.effort(); }

 private:
  EventEvidence compare(const ReceivingPoint& at, double step, std::span<const EdgeId> group);

  int emitter_;
  double shortest_edge_;
  VisiblePartFinder finder_;
  VisiblePart left_, right_;
};

}  // namespace halfshade
