#pragma once

#include "meshing/core/sound_scene.h"

#include <string>

namespace halfshade {

/// A sentence of emitters that shine on the back of a one-sided face close before them which looks
/// the same way, up to a thousandth of their size away: a lamp in a ceiling that the digits of a
/// file put above it. Nobody means that, and its light is lost. Empty if there are none.
std::string hidden_lamps(const SoundScene& scene);

}  // namespace halfshade
