#include "solver/pipeline/fewest_elements.h"

#include "meshing/patches/patch_mesh.h"

namespace halfshade {
namespace {

/// Whether it is too much is asked before.
constexpr std::size_t no_limit = 1'000'000'000;

}  // namespace

ElementTable fewest_elements(const SoundScene& scene, const Progress& progress) {
  PlanarMeshOptions coarsest;
  coarsest.min_angle = 0;
  coarsest.max_triangles = no_limit;
  return PatchMesh(scene, coarsest, progress).elements();
}

}  // namespace halfshade
