#include "solver/direct/ray_emitter.h"

#include "meshing/geometry/mix_bits.h"
#include "meshing/geometry/spread_pairs.h"
#include "meshing/triangulation/ring_triangles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// Directions that differ by less draw the same random numbers; above the rounding of coordinates.
constexpr double same_direction = 0x1p-24;

/// Far is what lies so many times its radius away, and whose heights over the horizon differ from
/// that of its centroid by no more than a share. Light from corners that differ by (1 ± .2) and
/// (1 ± .1)⁻⁴ is even enough for few rays, and what is not linear in places of the emitter changes
/// the mean by .067 at most.
constexpr double far_away = 10, alike_heights = 0.2;

void find_sphere(const std::vector<Vec3>& corners, RayEmitter& emitter) {
  if (emitter.triangles.empty()) return;
  Vec3 sum = Vec3::Zero();
  double before = 0;
  for (std::size_t k = 0; k < emitter.triangles.size(); ++k) {
    const auto& [a, b, c] = emitter.triangles[k];
    sum += (emitter.reached[k] - before) / 3 * (a + b + c);
    before = emitter.reached[k];
  }
  emitter.centroid = sum / emitter.area();
  for (const Vec3& corner : corners)
    emitter.radius = std::max(emitter.radius, (corner - emitter.centroid).norm());
}

}  // namespace

Vec3 RayEmitter::point(double s, double t) const {
  const double along = s * area();
  const auto first = std::upper_bound(reached.begin(), reached.end() - 1, along);
  const auto k = static_cast<std::size_t>(first - reached.begin());
  const double from = k == 0 ? 0 : reached[k - 1];
  const double rest = std::clamp((along - from) / (reached[k] - from), 0., 1.);
  return point_of(triangles[k], rest, t);
}

RayEmitter make_ray_emitter(const SoundScene& scene, int id) {
  const Surface& surface = scene.surfaces[at(id)];
  RayEmitter emitter;
  emitter.target = make_emitter_target(scene, surface);
  emitter.surface = id;
  emitter.plane = surface.plane;
  std::vector<Vec3> corners;
  for (const auto& ring : emitter.target.rings)
    corners.insert(corners.end(), ring.begin(), ring.end());
  double reached = 0;
  for (const auto& [i, j, k] : ring_triangles(surface.rings)) {
    const std::array<Vec3, 3> triangle = {corners[at(i)], corners[at(j)], corners[at(k)]};
    const double area = 0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).norm();
    if (!(area > 0)) continue;
    emitter.triangles.push_back(triangle);
    emitter.reached.push_back(reached += area);
  }
  find_sphere(corners, emitter);
  return emitter;
}

double far_factor(const SurfacePoint& point, const RayEmitter& emitter) {
  const EmitterTarget& target = emitter.target;
  const Vec3 way = emitter.centroid - point.position;
  const double square = way.squaredNorm();
  if (square < far_away * far_away * emitter.radius * emitter.radius) return -1;
  const double height = point.normal.dot(way), facing = -target.normal.dot(way);
  const double of_box = point.normal.dot(target.centre - point.position),
               half_box = point.normal.cwiseAbs().dot(target.half);
  if (of_box - half_box < (1 - alike_heights) * height ||
      of_box + half_box > (1 + alike_heights) * height || !(height > 0) || !(facing > 0))
    return -1;
  return emitter.area() * height * facing / (std::numbers::pi * square * square);
}

std::uint64_t seed_of(const Vec3& position, const EmitterTarget& target) {
  const Vec3 way = target.centre - position;
  const double size = way.lpNorm<Eigen::Infinity>();
  std::uint64_t bits = 0;
  for (int k = 0; k < 3 && size > 0; ++k)
    bits =
        mix_bits(bits ^ static_cast<std::uint64_t>(std::llround(way[k] / size / same_direction)));
  return bits;
}

}  // namespace halfshade
