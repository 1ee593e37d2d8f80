#pragma once

#include "meshing/core/sound_scene.h"

#include <vector>

namespace halfshade {

/// A scene whose coplanar neighbours are joined, whatever their materials and groups: what hides
/// things, or is looked at as a whole, is then few large polygons instead of many tiles. Only
/// rings, frames, planes and scales mean anything.
struct JoinedScene {
  SoundScene sound;
  std::vector<int> of;                  ///< surface → joined surface that it is a part of
  std::vector<std::vector<int>> parts;  ///< joined surface → its surfaces, rising
};

/// Surfaces with holes, and those of planes where joining would move anything, stay as they are.
JoinedScene join_coplanar(const SoundScene& scene);

}  // namespace halfshade
