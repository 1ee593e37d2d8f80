#include "solver/reflected/hemisphere_rays.h"

#include "meshing/core/plane_frame.h"
#include "meshing/geometry/hilbert_curve.h"
#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace halfshade {
namespace {

/// With so many rays together, packets are narrow enough.
constexpr std::size_t most_together = 4096;

/// Cells of the square, in the order in which a curve visits them.
constexpr int side = 32;
constexpr auto place_of_cell = [] {
  std::array<int, side * side> place{};
  for (std::size_t k = 0; k < place.size(); ++k)
    place[k] = place_on_hilbert_curve(side, static_cast<int>(k) % side, static_cast<int>(k) / side);
  return place;
}();

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

/// Of numbers in [0, 1), one of which rounding may make 1.
int cell_of(double x) { return std::min(static_cast<int>(side * x), side - 1); }

/// Adds the rays, and the places of their cells.
void add_rays(const RayHemisphere& hemisphere, std::vector<HalfLine>& rays,
              std::vector<int>& look) {
  const auto& [from, strata, seed] = hemisphere;
  const PlaneFrame frame = make_frame(from.position, from.normal);
  const std::vector<int> across = shuffled(strata, mix_bits(seed ^ 0x2545f491)),
                         along = shuffled(strata, mix_bits(seed ^ 0x6c62272e));
  std::uint64_t number = 0;
  for (int i = 0; i < strata; ++i)
    for (int j = 0; j < strata; ++j, number += 2) {
      const double u = (i + (across[at(j)] + random_number(seed, number)) / strata) / strata;
      const double v = (j + (along[at(i)] + random_number(seed, number + 1)) / strata) / strata;
      const Vec2 d = on_disc(u, v);
      const double height = std::sqrt(std::max(0., 1 - d.squaredNorm()));
      rays.push_back({from.position, d.x() * frame.e1 + d.y() * frame.e2 + height * frame.normal});
      look.push_back(place_of_cell[at(cell_of(u) + side * cell_of(v))]);
    }
}

/// The place of each of some numbers below side² when they are sorted; equal ones keep their order.
void sort_by_counting(std::span<const int> numbers, std::vector<int>& order) {
  std::array<int, side * side + 1> next{};
  for (const int n : numbers) ++next[at(n + 1)];
  std::partial_sum(next.begin(), next.end(), next.begin());
  order.clear();
  for (const int n : numbers) order.push_back(next[at(n)]++);
}

/// Whether a ray has come to a front: where it met the back of one that another lies back to back
/// with, `hit` is the other.
bool is_at_front(const ReflectingScene& scene, const HalfLine& ray, Hit& hit) {
  if (scene.roots.normal[at(hit.triangle)].dot(ray.direction) < 0) return true;
  if (!scene.two_sided[at(hit.triangle)]) return false;
  const std::optional<Hit> front = scene.visibility.facing_hit(ray, hit);
  if (front) hit = *front;
  return front.has_value();
}

/// Some of the hemispheres, at once.
void trace(const ReflectingScene& scene, std::span<const RayHemisphere> hemispheres,
           TracedHemispheres& traced) {
  std::vector<HalfLine> rays;
  std::vector<int> look, order;
  for (const RayHemisphere& hemisphere : hemispheres) add_rays(hemisphere, rays, look);
  sort_by_counting(look, order);
  std::vector<HalfLine> in_order(rays.size());
  std::vector<Hit> hits(rays.size());
  for (std::size_t k = 0; k < rays.size(); ++k) in_order[at(order[k])] = rays[k];
  scene.visibility.first_hits(in_order, Sides::both, hits);
  std::size_t k = 0;
  for (const auto& [from, strata, seed] : hemispheres) {
    const std::size_t before = traced.ends.size();
    for (const std::size_t end = k + at(strata * strata); k < end; ++k) {
      Hit& hit = hits[at(order[k])];
      if (hit.triangle < 0 || !is_at_front(scene, rays[k], hit)) continue;
      if (from.cell >= 0 && scene.cells.before(hit.triangle) != from.cell) continue;
      traced.ends.push_back(
          {hit.triangle, static_cast<float>(hit.weights[1]), static_cast<float>(hit.weights[2])});
    }
    const int found = static_cast<int>(traced.ends.size() - before);
    traced.of_each.push_back({static_cast<int>(before), static_cast<int>(traced.ends.size()),
                              from.is_closed && found > 0 ? found : strata * strata});
  }
}

}  // namespace

TracedHemispheres trace_hemispheres(const ReflectingScene& scene,
                                    std::span<const RayHemisphere> hemispheres) {
  TracedHemispheres traced;
  std::size_t all = 0;
  for (const RayHemisphere& h : hemispheres) all += at(h.strata * h.strata);
  traced.ends.reserve(all);
  for (std::size_t first = 0, last = 0; first < hemispheres.size(); first = last) {
    for (std::size_t rays = 0; last < hemispheres.size() && rays < most_together; ++last)
      rays += at(hemispheres[last].strata * hemispheres[last].strata);
    trace(scene, hemispheres.subspan(first, last - first), traced);
  }
  return traced;
}

}  // namespace halfshade
