#pragma once

#include "meshing/core/sound_scene.h"

#include <vector>

namespace halfshade {

/// Backs of those surfaces of which `has_back`, one entry a surface, says so, but for the parts on
/// which a surface of the same plane lies that looks the other way: what stands flat on a face
/// hides that much of its back. A back may be in several parts, each a surface, or none. They have
/// the contacts of their front, beyond their own rings, too. All pairs in a plane are compared;
/// throws as overlay() does.
std::vector<Surface> uncovered_backs(const SoundScene& scene, const std::vector<bool>& has_back);

}  // namespace halfshade
