#include "solver/reflected/first_light.h"

namespace halfshade {

FirstLight first_light(const SoundScene& scene, const ElementTable& roots, DirectIrradiance direct,
                       bool through_operator) {
  FirstLight light;
  light.surface = roots.surface;
  for (const int m : roots.material) {
    light.rho.push_back(scene.materials[at(m)].rho);
    light.exitance.push_back(scene.materials[at(m)].exitance);
  }
  light.direct = std::move(direct);
  light.through_operator = through_operator;
  return light;
}

}  // namespace halfshade
