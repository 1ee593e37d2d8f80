#pragma once

#include "meshing/core/sound_scene.h"

namespace halfshade {

class OpaqueScene;

/// How far to the sides of a curve it is tested what is seen there: far above rounding, far below
/// the size of anything. A length.
double side_step(const SoundScene& scene, const OpaqueScene& opaque);

}  // namespace halfshade
