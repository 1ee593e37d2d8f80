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

/// Rays that go together, with the places of the cells that they go through.
struct RayBundle {
  std::vector<HalfLine> rays;
  std::vector<int> look;

  /// `frame` stands where the ray starts, `u` and `v` are its point of the square.
  void add(const PlaneFrame& frame, double u, double v) {
    const Vec2 d = on_disc(u, v);
    const double height = std::sqrt(std::max(0., 1 - d.squaredNorm()));
    rays.push_back({frame.origin, d.x() * frame.e1 + d.y() * frame.e2 + height * frame.normal});
    look.push_back(place_of_cell[at(cell_of(u) + side * cell_of(v))]);
  }
};

void add_rays(const RayHemisphere& hemisphere, RayBundle& bundle) {
  const auto& [from, strata, seed] = hemisphere;
  const PlaneFrame frame = make_frame(from.position, from.normal);
  const std::vector<int> across = shuffled(strata, mix_bits(seed ^ 0x2545f491)),
                         along = shuffled(strata, mix_bits(seed ^ 0x6c62272e));
  std::uint64_t number = 0;
  for (int i = 0; i < strata; ++i)
    for (int j = 0; j < strata; ++j, number += 2)
      bundle.add(frame, (i + (across[at(j)] + random_number(seed, number)) / strata) / strata,
                 (j + (along[at(i)] + random_number(seed, number + 1)) / strata) / strata);
}

/// The place of each of some numbers below side² when they are sorted; equal ones keep their order.
void sort_by_counting(std::span<const int> numbers, std::vector<int>& order) {
  std::array<int, side * side + 1> next{};
  for (const int n : numbers) ++next[at(n + 1)];
  std::partial_sum(next.begin(), next.end(), next.begin());
  order.clear();
  for (const int n : numbers) order.push_back(next[at(n)]++);
}

/// What the rays meet first, those together that look the same way.
std::vector<Hit> first_hits(const ReflectingScene& scene, const RayBundle& bundle) {
  std::vector<int> order;
  sort_by_counting(bundle.look, order);
  std::vector<HalfLine> in_order(bundle.rays.size());
  std::vector<Hit> sorted(bundle.rays.size()), hits;
  for (std::size_t k = 0; k < order.size(); ++k) in_order[at(order[k])] = bundle.rays[k];
  scene.visibility.first_hits(in_order, Sides::both, sorted);
  hits.reserve(sorted.size());
  for (const int place : order) hits.push_back(sorted[at(place)]);
  return hits;
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

/// Where a ray ends; at triangle −1 if light that arrives there does not come from a front.
RayEnd end_of(const ReflectingScene& scene, const RayOrigin& from, const HalfLine& ray, Hit hit) {
  if (hit.triangle < 0 || !is_at_front(scene, ray, hit) ||
      (from.cell >= 0 && scene.cells.before(hit.triangle) != from.cell))
    return {-1, 0, 0};
  return {hit.triangle, static_cast<float>(hit.weights[1]), static_cast<float>(hit.weights[2])};
}

/// Some of the hemispheres, at once.
void trace(const ReflectingScene& scene, std::span<const RayHemisphere> hemispheres,
           TracedHemispheres& traced) {
  RayBundle bundle;
  for (const RayHemisphere& hemisphere : hemispheres) add_rays(hemisphere, bundle);
  const std::vector<Hit> hits = first_hits(scene, bundle);
  std::size_t k = 0;
  for (const auto& [from, strata, seed] : hemispheres) {
    const std::size_t before = traced.ends.size();
    for (const std::size_t end = k + at(strata * strata); k < end; ++k) {
      const RayEnd found = end_of(scene, from, bundle.rays[k], hits[k]);
      if (found.triangle >= 0) traced.ends.push_back(found);
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

std::vector<RayEnd> trace_rays(const ReflectingScene& scene, std::span<const RayOrigin> from,
                               std::span<const Vec2> on_square) {
  RayBundle bundle;
  for (std::size_t k = 0; k < from.size(); ++k)
    bundle.add(make_frame(from[k].position, from[k].normal), on_square[k].x(), on_square[k].y());
  const std::vector<Hit> hits = first_hits(scene, bundle);
  std::vector<RayEnd> ends;
  ends.reserve(from.size());
  for (std::size_t k = 0; k < from.size(); ++k)
    ends.push_back(end_of(scene, from[k], bundle.rays[k], hits[k]));
  return ends;
}

}  // namespace halfshade
