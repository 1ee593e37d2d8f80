#pragma once

#include "meshing/events/emitter_stage.h"
#include "meshing/events/swath.h"

#include <functional>
#include <vector>

namespace halfshade {

/// Takes one swath after the other.
using SwathSink = std::function<void(const Swath&)>;

/// Swaths through an edge of the stage and a point: a corner of the emitter (emitter EV), or
/// another vertex of the scene (non-emitter EV) if a line through both can come from the emitter.
void edge_swaths(const EmitterStage& stage, int edge, const SwathSink& sink);

/// Swaths through a vertex of the stage and the emitter's edges (VE).
void vertex_swaths(const EmitterStage& stage, int vertex, const SwathSink& sink);

/// Swaths in the plane of a receiver that cuts the emitter: there its silhouette jumps from some of
/// its edges to others.
void face_swaths(const SoundScene& scene, const EmitterStage& stage, const OpaqueScene& opaque,
                 int receiver, const SwathSink& sink);

/// False only if no line through both spans, in front of the emitter's plane, comes from the
/// emitter.
bool may_line_up(const EmitterStage& stage, const Span3& a, const Span3& b);

/// For each edge of the stage the later ones that can line up with it, seen from the emitter.
std::vector<int> later_partners(const EmitterStage& stage, int edge);

/// Swaths through an edge of the emitter and two of the stage (emitter EEE).
void pair_swaths(const EmitterStage& stage, int a, int b, const SwathSink& sink);

/// The swath through three edges of the stage (EEE).
void triple_swath(const EmitterStage& stage, int a, int b, int c, const SwathSink& sink);

}  // namespace halfshade
