#pragma once

#include "meshing/core/sound_scene.h"

#include <vector>

namespace halfshade {

/// The mean of the corners of a surface's outline; not always inside.
inline Vec3 middle(const Surface& surface) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& p : surface.rings.front()) sum += p;
  return surface.frame.to_space(sum / static_cast<double>(surface.rings.front().size()));
}

/// The middle of a surface, and places so far from it towards up to eight of its corners, a little
/// aside of them: lines of sight through symmetric places would end on edges of elements.
std::vector<Vec3> middle_and_around(const Surface& surface, double towards);

/// So far from the middle of a source that nearly all of it is between: what arrives close to a
/// wall comes from one side.
inline constexpr double towards_corner = 0.893;

}  // namespace halfshade
