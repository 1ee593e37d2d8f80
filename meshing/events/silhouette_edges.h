#pragma once

#include "meshing/events/emitter_scene.h"
#include "meshing/events/vertex_heights.h"

namespace halfshade {

/// Fills edges, faces and vertices of an emitter's scene: the edges in front of the
/// emitter that are silhouettes seen from some of its points. Needs its frame, slack and hull.
/// `among`: surface → whether its edges count; empty: all do.
void add_silhouettes(const SoundScene& scene, const OpaqueTopology& opaque,
                     const VertexHeights& heights, const std::vector<bool>& among,
                     EmitterScene& out);

}  // namespace halfshade
