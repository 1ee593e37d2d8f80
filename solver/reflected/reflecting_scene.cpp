#include "solver/reflected/reflecting_scene.h"

#include "meshing/geometry/mix_bits.h"
#include "meshing/patches/patch_mesh.h"
#include "solver/exchange/element_soup.h"

#include <utility>

namespace halfshade {
namespace {

/// What surfaces and contacts alone take is needed: whether it is too much is asked before.
constexpr std::size_t any_number = 1'000'000'000;

}  // namespace

double random_number(std::uint64_t seed, std::uint64_t place) {
  return unit_share(mix_bits(seed + place * splitmix_step));
}

ReflectingScene make_reflecting_scene(const SoundScene& scene, const Progress& progress) {
  PlanarMeshOptions coarsest;
  coarsest.min_angle = 0;
  coarsest.max_triangles = any_number;
  ElementTable roots = PatchMesh(scene, coarsest, progress).elements();
  SpaceCells cells = find_cells(scene, roots);
  std::vector<bool> two_sided;
  for (const int s : roots.surface)
    two_sided.push_back(scene.materials[at(scene.surfaces[at(s)].material)].two_sided);
  VisibilityIndex visibility(element_soup(scene, roots));
  return {std::move(roots), std::move(cells), std::move(two_sided), std::move(visibility)};
}

}  // namespace halfshade
