#include "meshing/core/light_source.h"

#include <algorithm>

namespace halfshade {

std::vector<LightSource> light_sources(const SoundScene& scene) {
  std::vector<LightSource> sources;
  std::vector<double> power;
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
    const double exitance = scene.materials[at(scene.surfaces[r].material)].exitance.maxCoeff();
    power.push_back(exitance * area(scene.surfaces[r]));
    if (exitance > 0) sources.push_back({static_cast<int>(r), exitance});
  }
  std::stable_sort(sources.begin(), sources.end(), [&](const LightSource& a, const LightSource& b) {
    return power[at(a.surface)] > power[at(b.surface)];
  });
  return sources;
}

}  // namespace halfshade
