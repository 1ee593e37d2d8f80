#pragma once

#include "meshing/core/sound_scene.h"

#include <string>

namespace halfshade {

/// What a repair of the scene did, for the user: one sentence without a full stop that names faces
/// as the file counts them, with their lines, and the values that decided.
std::string sentence(const Repair& repair, const SoundScene& scene);

/// "degenerate_dropped" and so on: how reports name a kind.
const char* name_of(Repair::Kind kind);

}  // namespace halfshade
