#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/direct/direct_light.h"

#include <vector>

namespace halfshade {

/// A surface as what light comes from.
struct EmitterTarget {
  std::vector<std::vector<Vec3>> rings;  ///< counter-clockwise seen from the front, then the holes
  Vec3 centre, half;                     ///< of the bounding box
  Vec3 origin, normal;                   ///< of its plane
  Rgb exitance;
  double strength = 0;  ///< mean of the exitance's channels
  double scale = 0;     ///< size of its coordinates
};

EmitterTarget make_emitter_target(const SoundScene& scene, const Surface& surface);

/// True if no light can pass between the two for sure, whatever is in between.
bool is_clearly_away(const EmitterTarget& target, const SurfacePoint& point);

}  // namespace halfshade
