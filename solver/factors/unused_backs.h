#pragma once

#include "meshing/core/sound_scene.h"

#include <vector>

namespace halfshade {

/// Backs of surfaces, but for those parts where a surface that looks the other way lies: what
/// stands flat on a face hides that much of its back. One-sided surfaces of which `has_back` says
/// so; a back may be in several parts, each a surface. Their contacts are those of the front.
std::vector<Surface> uncovered_backs(const SoundScene& scene, const std::vector<bool>& has_back);

}  // namespace halfshade
