#pragma once

#include "meshing/events/emitter_scene.h"
#include "meshing/events/swath.h"

#include <functional>
#include <vector>

namespace halfshade {

/// Takes one swath after the other.
using SwathSink = std::function<void(const Swath&)>;

/// Swaths through a silhouette edge and a point: a corner of the emitter (emitter EV), or
/// another vertex of the scene (non-emitter EV) if a line through both can come from the emitter.
void edge_swaths(const EmitterScene& emitter_scene, int edge, const SwathSink& sink);

/// Swaths through a silhouette vertex and the emitter's edges (VE).
void vertex_swaths(const EmitterScene& emitter_scene, int vertex, const SwathSink& sink);

/// Swaths in the plane of a receiver that cuts the emitter: there its silhouette jumps from some of
/// its edges to others.
void face_swaths(const SoundScene& scene, const EmitterScene& emitter_scene,
                 const OpaqueScene& opaque, int receiver, const SwathSink& sink);

/// False only if no line through both spans, in front of the emitter's plane, comes from the
/// emitter.
bool may_line_up(const EmitterScene& emitter_scene, const Span3& a, const Span3& b);

/// The later silhouette edges that may line up with one, seen from the emitter, in order.
std::vector<int> later_partners(const EmitterScene& emitter_scene, int edge);

/// Swaths through an edge of the emitter and two silhouette edges (emitter EEE).
void pair_swaths(const EmitterScene& emitter_scene, int a, int b, const SwathSink& sink);

/// The swath through three silhouette edges (EEE).
void triple_swath(const EmitterScene& emitter_scene, int a, int b, int c, const SwathSink& sink);

}  // namespace halfshade
