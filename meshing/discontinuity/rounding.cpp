#include "meshing/discontinuity/rounding.h"

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/backprojection/opaque_topology.h"

#include <algorithm>
#include <limits>

namespace halfshade {
namespace {

// Side steps, relative to the scene's size and to a rounding of the largest coordinate.
constexpr double relative_step = 1e-9;
constexpr double roundings_per_step = 1e4;

}  // namespace

double side_step(const SoundScene& scene, const OpaqueScene& opaque) {
  return std::max(
      relative_step * scene.tolerance.scene_size,
      roundings_per_step * std::numeric_limits<double>::epsilon() * opaque.topology().magnitude);
}

}  // namespace halfshade
