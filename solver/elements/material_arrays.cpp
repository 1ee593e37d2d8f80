#include "solver/elements/material_arrays.h"

namespace halfshade {

MaterialArrays material_arrays(const SoundScene& scene, const ElementTable& elements) {
  MaterialArrays arrays{ChannelArray(elements.count(), 3), ChannelArray(elements.count(), 3)};
  for (int e = 0; e < elements.count(); ++e) {
    const Material& material = scene.materials.at(at(elements.material[at(e)]));
    arrays.rho.row(e) = material.rho.transpose();
    arrays.exitance.row(e) = material.exitance.transpose();
  }
  return arrays;
}

}  // namespace halfshade
