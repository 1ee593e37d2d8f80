#include "solver/elements/material_arrays.h"

#include "solver/elements/painted_triangle.h"

namespace halfshade {

MaterialArrays material_arrays(const SoundScene& scene, const ElementTable& elements) {
  MaterialArrays arrays{ChannelArray(elements.count(), 3), ChannelArray(elements.count(), 3)};
  for (int e = 0; e < elements.count(); ++e) {
    const Material& material = scene.materials.at(at(elements.material[at(e)]));
    arrays.rho.row(e) = material.rho.transpose();
    arrays.exitance.row(e) = material.exitance.transpose();
    if (scene.paints.empty()) continue;
    const Surface& surface = scene.surfaces[at(elements.surface[at(e)])];
    if (surface.paint >= 0)
      arrays.rho.row(e) = mean_reflectance(scene, surface, elements.triangle(e)).transpose();
  }
  return arrays;
}

}  // namespace halfshade
