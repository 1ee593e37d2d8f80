#include "solver/reflected/reflecting_scene.h"

#include "meshing/geometry/mix_bits.h"
#include "meshing/patches/patch_mesh.h"
#include "solver/exchange/element_soup.h"
#include "solver/reflected/seen_cells.h"

#include <map>
#include <set>
#include <utility>

namespace halfshade {
namespace {

/// What surfaces and contacts alone take is needed: whether it is too much is asked before.
constexpr std::size_t any_number = 1'000'000'000;

/// Plane → surfaces on it look both ways.
std::set<int> two_sided_planes(const SoundScene& scene) {
  std::map<int, Vec3> normal;
  std::set<int> result;
  for (const Surface& surface : scene.surfaces) {
    const Vec3& first = normal.try_emplace(surface.plane, surface.frame.normal).first->second;
    if (first.dot(surface.frame.normal) < 0) result.insert(surface.plane);
  }
  return result;
}

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
  const std::set<int> planes = two_sided_planes(scene);
  std::vector<bool> two_sided;
  for (const int s : roots.surface)
    two_sided.push_back(planes.count(scene.surfaces[at(s)].plane) > 0);
  VisibilityIndex visibility(element_soup(scene, roots));
  ReflectingScene result{std::move(roots), std::move(cells), std::move(two_sided),
                         std::move(visibility)};
  join_seen_cells(result);
  return result;
}

}  // namespace halfshade
