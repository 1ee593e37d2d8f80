#include "solver/reflected/hot_cells.h"

#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/elements/element_field.h"
#include "solver/elements/triangle_key.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace halfshade {
namespace {

constexpr double wanted_cells = 20000;
constexpr int looks = 2;
/// Of the mean; and the least share of all power that leaves.
constexpr double hot = 3, least_power = 0.1;
/// Aimed rays for each of the hemisphere.
constexpr double share_of_aimed = 0.35;

/// The cell of a triangle cut in columns² that a place lies in, of 2 columns²: (i, j) and whether
/// it is the one that points the other way.
int cell_of(const TrianglePlace& place, int columns) {
  const double s = columns * place.x(), t = columns * place.y();
  const int i = std::clamp(static_cast<int>(s), 0, columns - 1);
  const int j = std::clamp(static_cast<int>(t), 0, columns - 1 - i);
  const bool turned = s - i + t - j > 1 && i + j < columns - 1;
  return 2 * (i + j * columns) + (turned ? 1 : 0);
}

std::array<TrianglePlace, 3> corners_of(int i, int j, bool turned, int columns) {
  const auto at_node = [&](int k, int l) {
    return TrianglePlace(static_cast<double>(k) / columns, static_cast<double>(l) / columns);
  };
  if (turned) return {at_node(i + 1, j + 1), at_node(i, j + 1), at_node(i + 1, j)};
  return {at_node(i, j), at_node(i + 1, j), at_node(i, j + 1)};
}

TrianglePlace place_in(const std::array<TrianglePlace, 3>& corners, double u, double v) {
  const double across = std::sqrt(u);
  return corners[0] + across * (1 - v) * (corners[1] - corners[0]) +
         across * v * (corners[2] - corners[0]);
}

Vec3 position_at(const ElementTable& roots, int root, const TrianglePlace& place) {
  return position(roots.triangle(root), place);
}

}  // namespace

HotCells::HotCells(const ReflectingScene& scene, const HugeRoots& huge, const Leaving& leaving) {
  const ElementTable& roots = scene.roots;
  double area = 0;
  for (int r = 0; r < roots.count(); ++r) area += huge(r) ? 0 : roots.area[at(r)];
  std::vector<Cell> cells;
  std::vector<int> index;
  int next = 0;
  for (int r = 0; r < roots.count(); ++r) {
    const double wanted = std::sqrt(wanted_cells * std::min(roots.area[at(r)] / area, 1.));
    const int columns = std::max(1, static_cast<int>(std::lround(wanted)));
    columns_.push_back(columns);
    first_.push_back(next);
    for (int i = 0; i < columns; ++i)
      for (int j = 0; j < columns - i; ++j)
        for (const bool turned : {false, true}) {
          if (turned && i + j == columns - 1) continue;
          cells.push_back({r, corners_of(i, j, turned, columns), 0});
          index.push_back(next + 2 * (i + j * columns) + (turned ? 1 : 0));
        }
    next += 2 * columns * columns;
  }
  parallel_for(cells.size(), [&](std::size_t c) {
    Cell& cell = cells[c];
    const std::uint64_t seed =
        mix_bits(triangle_key(roots.triangle(cell.root)) +
                 static_cast<std::uint64_t>(index[c] - first_[at(cell.root)]));
    for (std::uint64_t k = 0; k < 2 * looks; k += 2) {
      const TrianglePlace place =
          place_in(cell.corners, random_number(seed, k), random_number(seed, k + 1));
      cell.density += leaving(cell.root, position_at(roots, cell.root, place)).sum() / looks;
    }
  });
  const auto area_of = [&](const Cell& cell) {
    const double columns = columns_[at(cell.root)];
    return roots.area[at(cell.root)] / (columns * columns);
  };
  double power = 0, of_hot = 0;
  for (const Cell& cell : cells) power += area_of(cell) * cell.density;
  density_.assign(at(next), 0);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!(cells[c].density > hot * power / area)) continue;
    of_hot += area_of(cells[c]) * cells[c].density;
    hot_.push_back(cells[c]);
    up_to_.push_back(of_hot);
    density_[at(index[c])] = cells[c].density;
  }
  if (!(of_hot > least_power * power)) {
    hot_.clear();
    return;
  }
  for (double& d : density_) d /= of_hot;
  for (Cell& cell : hot_) cell.density /= of_hot;
  for (double& share : up_to_) share /= of_hot;
}

int HotCells::count(int rays) const {
  return hot_.empty() ? 0 : static_cast<int>(std::ceil(share_of_aimed * rays));
}

double HotCells::density(int root, const TrianglePlace& place) const {
  return density_[at(first_[at(root)] + cell_of(place, columns_[at(root)]))];
}

double HotCells::expected(const ReflectingScene& scene, const RayOrigin& from, int root,
                          const Vec3& position, double density) const {
  const Vec3 d = position - from.position;
  const double here = from.normal.dot(d), there = -scene.roots.normal[at(root)].dot(d);
  const double square = d.squaredNorm();
  if (!(here > 0 && there > 0)) return -1;
  return density * std::numbers::pi * square * square / (here * there);
}

Rgb HotCells::by_aimed_rays(const ReflectingScene& scene, const Leaving& leaving,
                            const RayOrigin& from, int rays, int aimed, std::uint64_t seed) const {
  std::vector<Segment> segments;
  std::vector<Rgb> light;
  std::vector<std::uint8_t> blocked;
  const std::uint64_t own = mix_bits(seed ^ 0x5bd1e995);
  for (int k = 0; k < aimed; ++k) {
    const std::uint64_t n = 3 * static_cast<std::uint64_t>(k);
    const double share = (k + random_number(own, n)) / aimed;
    const std::size_t c =
        std::min(hot_.size() - 1,
                 static_cast<std::size_t>(std::upper_bound(up_to_.begin(), up_to_.end(), share) -
                                          up_to_.begin()));
    const Cell& cell = hot_[c];
    if (from.cell >= 0 && scene.cells.before(cell.root) != from.cell) continue;
    const TrianglePlace place =
        place_in(cell.corners, random_number(own, n + 1), random_number(own, n + 2));
    const Vec3 position = position_at(scene.roots, cell.root, place);
    const double other = expected(scene, from, cell.root, position, cell.density);
    if (other < 0) continue;
    segments.push_back(
        {from.position, position, from.plane, scene.visibility.soup().plane[at(cell.root)]});
    light.push_back(leaving(cell.root, position) / (rays + aimed * other));
  }
  blocked.resize(segments.size());
  scene.visibility.blocked(segments, blocked);
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (blocked[i] == 0) sum += light[i];
  return sum;
}

Rgb HotCells::irradiance(const ReflectingScene& scene, const Leaving& leaving,
                         const RayOrigin& from, int strata, int rays, std::span<const RayEnd> ends,
                         std::uint64_t seed) const {
  const int cast = strata * strata, aimed = count(cast);
  Rgb sum = Rgb::Zero();
  for (const RayEnd& end : ends) {
    const Vec3 position = position_at(scene.roots, end.triangle, end.place());
    const double here = aimed == 0 ? 0 : density(end.triangle, end.place());
    const double other =
        here > 0 ? std::max(expected(scene, from, end.triangle, position, here), 0.) : 0;
    sum += leaving(end.triangle, position) / (1 + aimed * other / cast);
  }
  sum /= rays;
  if (aimed > 0) sum += by_aimed_rays(scene, leaving, from, cast, aimed, seed);
  return sum;
}

}  // namespace halfshade
