#pragma once

#include "solver/elements/solution.h"

#include <array>
#include <cstdint>

namespace halfshade {

/// Where the emitted power of one channel is at a stage, in W (for lengths in metres). What is
/// emitted is unshot + absorbed + escaped at every stage.
struct StagePower {
  double shot = 0;      ///< all that was sent so far; light counts again at each reflection
  double unshot = 0;    ///< still to be sent
  double absorbed = 0;  ///< where it arrived
  double escaped = 0;   ///< through openings
  double ambient = 0;   ///< irradiance that is shown for what is unshot, W/m²
  double balance = 0;   ///< |emitted − unshot − absorbed − escaped| / emitted
};

/// A stage of progressive refinement.
struct RadiosityStage {
  std::int64_t shots = 0;   ///< each emitting element's first one included
  ChannelArray irradiance;  ///< as it is shown: with the ambient term, if there is one
  std::array<StagePower, 3> power;
};

}  // namespace halfshade
