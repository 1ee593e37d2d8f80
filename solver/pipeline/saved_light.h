#pragma once

#include "solver/reflected/reflected_light.h"

#include <string>
#include <vector>

namespace halfshade {

/// All irradiance that a solution has left behind.
struct SavedLight {
  ElementTable elements;    ///< points, corners and surfaces, by the numbers that solve gives them
  ElementField irradiance;  ///< on them, W/m²
  std::vector<Rgb> rho, exitance;  ///< of each
  std::string source;              ///< a file, for messages
};

/// What arrives of what that light leaves by reflection, as ReflectedLight::gather finds it by
/// rays; its own irradiance is zero. Throws Error(invalid_input) unless the elements cover the
/// scene's surfaces, each in its own, and are of their materials.
ReflectedLight reflection_of(const SoundScene& scene, SavedLight light,
                             const Progress& progress = {});

}  // namespace halfshade
