#pragma once

#include "meshing/core/sound_scene.h"

#include <vector>

namespace halfshade {

/// A polygon that sends light.
struct LightSource {
  int surface = 0;
  double exitance = 0;  ///< of the strongest channel; W/m², > 0
};

/// The surfaces with E > 0, those that send most power first.
std::vector<LightSource> light_sources(const SoundScene& scene);

}  // namespace halfshade
