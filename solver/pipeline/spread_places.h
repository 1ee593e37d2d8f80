#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/direct/direct_light.h"

#include <span>
#include <vector>

namespace halfshade {

struct SpreadPlaces {
  std::vector<SurfacePoint> points;
  std::vector<double> area;  ///< that each stands for
};

/// So many places for equal areas of some surfaces, whatever the lines between them.
SpreadPlaces spread_places(const SoundScene& scene, std::span<const int> ids, int count);

/// One place on each of so many of them, or on all if there are fewer.
std::vector<SurfacePoint> places_of_surfaces(const SoundScene& scene, std::span<const int> ids,
                                             int count);

}  // namespace halfshade
