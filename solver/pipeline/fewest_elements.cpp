#include "solver/pipeline/fewest_elements.h"

#include "meshing/patches/patch_mesh.h"

namespace halfshade {
namespace {

/// Whether it is too much is asked before.
constexpr std::size_t any_number = 1'000'000'000;

}  // namespace

ElementTable fewest_elements(const SoundScene& scene) {
  PlanarMeshOptions coarsest;
  coarsest.min_angle = 0;
  coarsest.max_triangles = any_number;
  return PatchMesh(scene, coarsest).elements();
}

}  // namespace halfshade
