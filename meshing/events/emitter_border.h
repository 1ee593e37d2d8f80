#pragma once

#include "meshing/events/emitter_scene.h"
#include "meshing/events/vertex_heights.h"

namespace halfshade {

/// Fills outline and corners of an emitter's scene: the emitter's own border, and where something
/// touches or cuts its plane. Needs the rest of it.
void add_border(const OpaqueTopology& opaque, const VertexHeights& heights, EmitterScene& out);

}  // namespace halfshade
