#pragma once

#include "solver/heat/heat.h"
#include "solver/pipeline/warnings.h"

#include <vector>

namespace halfshade {

/// Backs of one-sided faces count as surroundings. Where they do so in a part of space that is
/// bounded, as inside of a body that reaches through a wall, or where surfaces touch, as below a
/// body on a floor, a sentence names the groups that exchange heat with them: it is hardly meant.
std::vector<Warning> back_warnings(const SoundScene& scene, const Heat& heat);

}  // namespace halfshade
