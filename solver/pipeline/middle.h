#pragma once

#include "meshing/core/sound_scene.h"

namespace halfshade {

/// The mean of the corners of a surface's outline; not always inside.
inline Vec3 middle(const Surface& surface) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& p : surface.rings.front()) sum += p;
  return surface.frame.to_space(sum / static_cast<double>(surface.rings.front().size()));
}

}  // namespace halfshade
