#include "solver/reflected/reflecting_scene.h"

#include "meshing/core/plane_frame.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/patches/patch_mesh.h"
#include "solver/exchange/element_soup.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace halfshade {
namespace {

/// What surfaces and contacts alone take is needed: whether it is too much is asked before.
constexpr std::size_t any_number = 1'000'000'000;

/// The unit square to the unit disc, equal areas to equal areas (Shirley and Chiu 1997).
Vec2 on_disc(double u, double v) {
  const double x = 2 * u - 1, y = 2 * v - 1;
  if (x == 0 && y == 0) return Vec2::Zero();
  constexpr double quarter = std::numbers::pi / 4;
  const bool wide = std::abs(x) > std::abs(y);
  const double r = wide ? x : y;
  const double angle = wide ? quarter * (y / x) : 2 * quarter - quarter * (x / y);
  return {r * std::cos(angle), r * std::sin(angle)};
}

/// The numbers from 0 to `count` − 1 in random order.
std::vector<int> shuffled(int count, std::uint64_t seed) {
  std::vector<int> order(at(count));
  std::iota(order.begin(), order.end(), 0);
  for (int i = count - 1; i > 0; --i) {
    const double place = random_number(seed, static_cast<std::uint64_t>(i)) * (i + 1);
    std::swap(order[at(i)], order[static_cast<std::size_t>(place)]);
  }
  return order;
}

/// Directions in square tiles of 16, so that packets are narrow.
void fill_directions(const RayOrigin& from, int strata, std::uint64_t seed,
                     std::vector<Vec3>& directions) {
  const PlaneFrame frame = make_frame(from.position, from.normal);
  const std::vector<int> across = shuffled(strata, mix_bits(seed ^ 0x2545f491)),
                         along = shuffled(strata, mix_bits(seed ^ 0x6c62272e));
  constexpr int tile = 4;
  directions.clear();
  std::uint64_t place = 0;
  for (int bi = 0; bi < strata; bi += tile)
    for (int bj = 0; bj < strata; bj += tile)
      for (int i = bi; i < std::min(bi + tile, strata); ++i)
        for (int j = bj; j < std::min(bj + tile, strata); ++j, place += 2) {
          const double u = (across[at(j)] + random_number(seed, place)) / strata;
          const double v = (along[at(i)] + random_number(seed, place + 1)) / strata;
          const Vec2 d = on_disc((i + u) / strata, (j + v) / strata);
          const double height = std::sqrt(std::max(0., 1 - d.squaredNorm()));
          directions.push_back(d.x() * frame.e1 + d.y() * frame.e2 + height * frame.normal);
        }
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
  std::vector<bool> two_sided;
  for (const int s : roots.surface)
    two_sided.push_back(scene.materials[at(scene.surfaces[at(s)].material)].two_sided);
  VisibilityIndex visibility(element_soup(scene, roots));
  return {std::move(roots), std::move(cells), std::move(two_sided), std::move(visibility)};
}

bool HemisphereRays::find_other_side(const RayOrigin& from, std::size_t ray, Hit& hit) const {
  // Rounding of the distance to a plane, for rays that are not too grazing.
  constexpr double same = 1e-9;
  const auto front =
      scene_->visibility.first_hit(from.position, directions_[ray], Sides::front_only);
  if (!front || front->distance > (1 + same) * hit.distance) return false;
  hit = *front;
  return true;
}

int HemisphereRays::cast(const RayOrigin& from, int strata, std::uint64_t seed,
                         std::vector<RayEnd>& ends) {
  fill_directions(from, strata, seed, directions_);
  hits_.resize(directions_.size());
  scene_->visibility.first_hits(from.position, directions_, Sides::both, hits_);
  const std::size_t before = ends.size();
  for (std::size_t k = 0; k < hits_.size(); ++k) {
    Hit hit = hits_[k];
    if (hit.triangle < 0) continue;
    if (scene_->roots.normal[at(hit.triangle)].dot(directions_[k]) >= 0 &&
        !(scene_->two_sided[at(hit.triangle)] && find_other_side(from, k, hit)))
      continue;
    if (from.cell >= 0 && scene_->cells.before(hit.triangle) != from.cell) continue;
    ends.push_back(
        {hit.triangle, static_cast<float>(hit.weights[1]), static_cast<float>(hit.weights[2])});
  }
  const int found = static_cast<int>(ends.size() - before);
  return from.is_closed && found > 0 ? found : strata * strata;
}

}  // namespace halfshade
