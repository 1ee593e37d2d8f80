#include "meshing/core/tolerance.h"

#include <cmath>

namespace halfshade {

Tolerance make_tolerance(const Scene& scene) {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const Face& face : scene.faces)
    for (const int v : face.vertices) {
      low = low.cwiseMin(scene.vertices[static_cast<std::size_t>(v)]);
      high = high.cwiseMax(scene.vertices[static_cast<std::size_t>(v)]);
    }
  // Files carry six to nine digits, so a decimal rounding of a coordinate must not make a polygon
  // non-planar (1e-6), while distinct vertices a millionth of the scene apart stay distinct (1e-9).
  Tolerance tolerance;
  tolerance.scene_size = (high - low).stableNorm();
  tolerance.length = 1e-9 * tolerance.scene_size;
  tolerance.planarity = 1e-6 * tolerance.scene_size;
  return tolerance;
}

}  // namespace halfshade
