#pragma once

#include "solver/linear/classic_solvers.h"
#include "solver/linear/light_exchange.h"
#include "solver/linear/radiosity_stages.h"

#include <array>
#include <vector>

namespace halfshade {

/// The stages of all channels as those of one progress: at first nothing is sent, then emitters
/// have sent their light, then comes what was shot; a channel that is done early waits for the
/// others. `solution` has reflectance, exitance and direct irradiance; channels without stages are
/// like the first.
std::vector<RadiosityStage> combine_stages(const LightExchange& exchange, const Solution& solution,
                                           const std::array<std::vector<ShotStage>, 3>& channels);

}  // namespace halfshade
