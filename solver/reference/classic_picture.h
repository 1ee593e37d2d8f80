#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/reference/traced_picture.h"

#include <vector>

namespace halfshade {

enum class ClassicShadows {
  none,  ///< emitters are points and nothing hides them
  hard,  ///< emitters are points
  soft   ///< rays to random points of emitters (Cook, Porter and Carpenter 1984)
};

struct ClassicOptions {
  ClassicShadows shadows = ClassicShadows::soft;
  /// Irradiance that is everywhere in the place of what surfaces reflect, W/m²; < 0: what the
  /// emitted power comes to after its first reflection, spread evenly over all surfaces.
  double ambient = -1;
  double highlight = 0;  ///< share of direct light that shines as a highlight (Phong 1975), ≥ 0
  double exponent = 40;  ///< of it, ≥ 1
  std::vector<bool> mirrors;  ///< surfaces that are mirrors; may be shorter: the rest is not
  int most_mirrors = 8;       ///< along a ray
};

/// The ambient term of a scene.
Rgb evenly_spread_light(const SoundScene& scene);

/// A picture by local illumination, as it was before radiosity, to see what it misses: direct light
/// and a constant instead of all that surfaces reflect to each other; mirrors that reflect all
/// (Whitted 1980). Throws Error(contract) for options out of range.
TracedPicture classic_picture(const SoundScene& scene, const CameraRays& camera,
                              const ClassicOptions& options, const PixelOptions& pixels,
                              const Progress& progress = {});

}  // namespace halfshade
