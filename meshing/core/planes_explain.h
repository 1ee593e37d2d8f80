#pragma once

#include "meshing/core/sound_scene.h"

namespace halfshade {

/// Whether the planes of two surfaces, each off its corners by at most the planarity, explain that
/// a point of both lies here in one and, moved by `offset`, in the other. Parallel planes do not:
/// surfaces that lie in one plane to within the tolerance have the same plane, and two that face
/// each other across a gap are not to be joined.
bool planes_explain(const Vec3& offset, const Surface& a, const Surface& b);

}  // namespace halfshade
