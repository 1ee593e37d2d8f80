#pragma once

#include "meshing/backprojection/visible_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

/// Independent ways to find what is visible of an emitter.
namespace halfshade::test {

/// The visible part, from scratch.
inline VisiblePart find_visible(const SoundScene& scene, const Vec3& point,
                                const Vec3& normal = Vec3::UnitZ(), int emitter = 0) {
  const OpaqueScene opaque(scene);
  VisiblePartFinder finder(opaque);
  VisiblePart part;
  finder.find(point, normal, emitter, part);
  return part;
}

using LongVec = Eigen::Matrix<long double, 3, 1>;
using LongVec2 = Eigen::Matrix<long double, 2, 1>;

/// Lambert's edge sum over the pieces of a boundary, in extended precision: the form factor.
inline double lambert(std::span<const BoundaryPiece> pieces, const Vec3& point,
                      const Vec3& normal) {
  long double sum = 0;
  for (const BoundaryPiece& piece : pieces) {
    const LongVec a = piece.from.cast<long double>() - point.cast<long double>();
    const LongVec b = piece.to.cast<long double>() - point.cast<long double>();
    const LongVec cross = a.cross(b);
    const long double sine = cross.norm();
    if (sine > 0) sum += std::atan2(sine, a.dot(b)) / sine * normal.cast<long double>().dot(cross);
  }
  return static_cast<double>(-sum / (2 * std::numbers::pi_v<long double>));
}

inline double factor(const VisiblePart& part, const Vec3& point,
                     const Vec3& normal = Vec3::UnitZ()) {
  return lambert(part.pieces, point, normal);
}

/// How far inside (+) or outside (−) of polygons with holes a point lies, by crossing number and
/// distance to the border.
template <class Polygons>
long double depth_inside(const Polygons& rings, const LongVec2& p) {
  bool inside = false;
  long double nearest = HUGE_VALL;
  for (const auto& ring : rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const LongVec2 a = ring[k].template cast<long double>();
      const LongVec2 b = ring[(k + 1) % ring.size()].template cast<long double>(), along = b - a;
      const long double length2 = along.squaredNorm();
      const long double t = length2 > 0 ? std::clamp(along.dot(p - a) / length2, 0.L, 1.L) : 0.L;
      nearest = std::min(nearest, (p - a - t * along).norm());
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * along.x())
        inside = !inside;
    }
  return inside ? nearest : -nearest;
}

/// Whether a surface's polygon lies between two points: the distance from its border if so, minus
/// the distance by which the segment misses it if not; points in its plane are not separated.
inline long double blocking_depth(const Surface& surface, const LongVec& from, const LongVec& to) {
  const LongVec origin = surface.frame.origin.cast<long double>();
  const LongVec normal = surface.frame.normal.cast<long double>();
  const long double h0 = normal.dot(from - origin), h1 = normal.dot(to - origin);
  if (std::abs(h0) < 1e-14L || std::abs(h1) < 1e-14L) return -1;
  if ((h0 > 0) == (h1 > 0)) return -std::min(std::abs(h0), std::abs(h1));
  const LongVec hit = from + h0 / (h0 - h1) * (to - from) - origin;
  const LongVec2 q(surface.frame.e1.cast<long double>().dot(hit),
                   surface.frame.e2.cast<long double>().dot(hit));
  return depth_inside(surface.rings, q);
}

/// Whether a point of the emitter is hidden from `point` by any other surface: positive if so; the
/// size tells how clear it is.
inline long double hidden_depth(const SoundScene& scene, int emitter, const Vec3& point,
                                const LongVec& target) {
  long double deepest = -HUGE_VALL;
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r)
    if (static_cast<int>(r) != emitter)
      deepest =
          std::max(deepest, blocking_depth(scene.surfaces[r], point.cast<long double>(), target));
  return deepest;
}

/// The number of sampled points of the emitter about which `part` is wrong. Points nearer than
/// `near` to an edge do not count; `tested` counts those that do.
inline int wrong_samples(const SoundScene& scene, int emitter, const Vec3& point,
                         const Vec3& normal, const VisiblePart& part, int per_side, double near,
                         int& tested) {
  const Surface& light = scene.surfaces[static_cast<std::size_t>(emitter)];
  std::vector<Ring> visible;
  for (const auto& ring : visible_rings(part, point, light.frame)) {
    visible.emplace_back();
    for (const Vec3& p : ring) visible.back().push_back(light.frame.to_plane(p));
  }
  Vec2 low = light.rings[0][0], high = low;
  for (const Vec2& q : light.rings[0]) {
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  int wrong = 0;
  for (int i = 0; i < per_side; ++i)
    for (int j = 0; j < per_side; ++j) {
      const Vec2 q = low + (high - low).cwiseProduct(Vec2(i + 0.4142, j + 0.7321) / per_side);
      const LongVec2 q2 = q.cast<long double>();
      const LongVec target = light.frame.to_space(q).cast<long double>();
      const long double on_light = depth_inside(light.rings, q2);
      const long double above = normal.cast<long double>().dot(target - point.cast<long double>());
      const long double hidden = hidden_depth(scene, emitter, point, target);
      const long double seen = depth_inside(visible, q2);
      if (std::min({std::abs(on_light), std::abs(above), std::abs(hidden), std::abs(seen)}) < near)
        continue;
      ++tested;
      if ((on_light > 0 && above > 0 && hidden < 0) != (seen > 0)) ++wrong;
    }
  return wrong;
}

/// Sutherland and Hodgman's clip of a convex polygon to (p − on)·inwards ≥ 0.
inline std::vector<LongVec> clip(const std::vector<LongVec>& polygon, const LongVec& on,
                                 const LongVec& inwards) {
  std::vector<LongVec> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const LongVec &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const long double u = inwards.dot(a - on), v = inwards.dot(b - on);
    if (u >= 0) kept.push_back(a);
    if ((u > 0 && v < 0) || (u < 0 && v > 0)) kept.push_back(a + u / (u - v) * (b - a));
  }
  return kept;
}

inline long double lambert(const std::vector<LongVec>& polygon, const LongVec& point,
                           const LongVec& normal) {
  long double sum = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const LongVec a = polygon[k] - point, b = polygon[(k + 1) % polygon.size()] - point;
    const LongVec cross = a.cross(b);
    if (const long double sine = cross.norm(); sine > 0)
      sum += std::atan2(sine, a.dot(b)) / sine * normal.dot(cross);
  }
  return -sum / (2 * std::numbers::pi_v<long double>);
}

/// Form factor to the visible part of a convex emitter behind convex polygons that lie between it
/// and the point, by inclusion and exclusion, in extended precision.
inline long double visible_factor(const std::vector<Vec3>& emitter,
                                  std::span<const std::vector<Vec3>> occluders, const Vec3& point,
                                  const Vec3& normal) {
  const LongVec x = point.cast<long double>(), n = normal.cast<long double>();
  std::vector<LongVec> above;
  for (const Vec3& p : emitter) above.push_back(p.cast<long double>());
  above = clip(above, x, n);
  long double sum = 0;
  for (unsigned subset = 0; subset < 1u << occluders.size(); ++subset) {
    std::vector<LongVec> common = above;
    int sign = 1;
    for (std::size_t o = 0; o < occluders.size(); ++o) {
      if ((subset >> o & 1) == 0) continue;
      sign = -sign;
      const auto& polygon = occluders[o];
      LongVec middle = LongVec::Zero();
      for (const Vec3& p : polygon)
        middle += (p.cast<long double>() - x) / static_cast<long double>(polygon.size());
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const LongVec a = polygon[k].cast<long double>() - x;
        const LongVec b = polygon[(k + 1) % polygon.size()].cast<long double>() - x;
        const LongVec side = a.cross(b);
        common = clip(common, x, side.dot(middle) > 0 ? side : LongVec(-side));
      }
    }
    sum += sign * lambert(common, x, n);
  }
  return sum;
}

}  // namespace halfshade::test
