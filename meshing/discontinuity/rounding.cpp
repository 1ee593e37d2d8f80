#include "meshing/discontinuity/rounding.h"

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/backprojection/opaque_topology.h"

#include <algorithm>
#include <limits>

namespace halfshade {

double side_step(const SoundScene& scene, const OpaqueScene& opaque) {
  return std::max(
      relative_step * scene.tolerance.scene_size,
      roundings_per_step * std::numeric_limits<double>::epsilon() * opaque.topology().magnitude);
}

}  // namespace halfshade
