#include "meshing/discontinuity/margins.h"

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/backprojection/opaque_topology.h"

#include <algorithm>
#include <limits>

namespace halfshade {

double side_step(const SoundScene& scene, const OpaqueScene& opaque) {
  return std::max(margins::relative_step * scene.tolerance.scene_size,
                  margins::roundings_per_step * std::numeric_limits<double>::epsilon() *
                      opaque.topology().magnitude);
}

}  // namespace halfshade
