#include "solver/reflected/exact_sight.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/backprojection/margins.h"
#include "meshing/backprojection/opaque_scene.h"
#include "meshing/core/planar.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

struct Target {
  std::vector<std::vector<Vec3>> rings;
  std::vector<int> roots, cells;
  double magnitude = 0;  ///< its largest coordinate
};

/// What each thread keeps between calls.
struct Sighter {
  VisiblePartFinder finder;
  VisiblePart part;
};

/// Whether a point that looks along or against a surface's normal was meant to lie in its plane.
bool is_meant_in_plane(const Surface& surface, const SurfacePoint& point) {
  return std::abs(surface.frame.normal.dot(point.normal)) > margins::same_normal &&
         std::abs(surface.frame.height(point.position)) <= tolerance_of(surface).length;
}

bool reaches_above(std::span<const Vec3> corners, const Vec3& origin, const Vec3& normal) {
  return std::any_of(corners.begin(), corners.end(),
                     [&](const Vec3& p) { return normal.dot(p - origin) > 0; });
}

/// The part of a ring above a horizon (Sutherland and Hodgman 1974), in the frame of its plane.
Ring clip(const std::vector<Vec3>& ring, const SurfacePoint& point, const PlaneFrame& frame) {
  Ring result;
  const auto height = [&](const Vec3& p) { return point.normal.dot(p - point.position); };
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec3 &a = ring[k], &b = ring[(k + 1) % ring.size()];
    const double at_a = height(a), at_b = height(b);
    if (at_a >= 0) result.push_back(frame.to_plane(a));
    if ((at_a >= 0) != (at_b >= 0))
      result.push_back(frame.to_plane(a + at_a / (at_a - at_b) * (b - a)));
  }
  return result;
}

/// Whether a ring runs straight on at q.
bool is_straight(const Vec2& p, const Vec2& q, const Vec2& r, double width) {
  return (q - p).dot(r - q) > 0 && std::abs(cross_2d(q - p, r - p)) <= width * (r - p).norm();
}

/// Leaves out corners at which a ring does not turn, and lets it begin at its lowest, by x, then y,
/// to a share of its size. Quadrature goes by triangles from there, while where outlines that were
/// found begin, and are parted, is a matter of rounding.
void tidy(Ring& ring) {
  constexpr double width = 1e-12, parts = 0x1p20;
  Vec2 low = ring.front(), high = low;
  for (const Vec2& p : ring) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high - low).maxCoeff();
  Ring apart, turns;
  for (const Vec2& p : ring)
    if (apart.empty() || (p - apart.back()).norm() > width * size) apart.push_back(p);
  while (apart.size() > 1 && (apart.back() - apart.front()).norm() <= width * size)
    apart.pop_back();
  for (std::size_t k = 0; k < apart.size(); ++k) {
    const Vec2& before = turns.empty() ? apart.back() : turns.back();
    if (!is_straight(before, apart[k], apart[(k + 1) % apart.size()], width * size))
      turns.push_back(apart[k]);
  }
  if (turns.size() > 2) ring = std::move(turns);
  const auto part = [&](double x) { return std::round(parts * x / size); };
  const auto is_lower = [&](const Vec2& p, const Vec2& q) {
    return part(p.x()) < part(q.x()) || (part(p.x()) == part(q.x()) && part(p.y()) < part(q.y()));
  };
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), is_lower), ring.end());
}

}  // namespace

struct ExactSight::Impl {
  const SoundScene& scene;
  const ReflectingScene& reflecting;
  OpaqueScene opaque;
  std::vector<Target> targets;  // by surface
  tbb::enumerable_thread_specific<Sighter> sighters;

  Impl(const SoundScene& s, const ReflectingScene& r)
      : scene(s), reflecting(r), opaque(s), targets(s.surfaces.size()), sighters([this] {
          return Sighter{VisiblePartFinder(opaque), {}};
        }) {
    for (std::size_t k = 0; k < scene.surfaces.size(); ++k)
      for (const Ring& ring : scene.surfaces[k].rings) {
        auto& corners = targets[k].rings.emplace_back();
        for (const Vec2& q : ring) {
          corners.push_back(scene.surfaces[k].frame.to_space(q));
          targets[k].magnitude =
              std::max(targets[k].magnitude, corners.back().lpNorm<Eigen::Infinity>());
        }
      }
    for (int root = 0; root < reflecting.roots.count(); ++root) {
      Target& target = targets[at(reflecting.roots.surface[at(root)])];
      target.roots.push_back(root);
      target.cells.push_back(reflecting.cells.before(root));
    }
  }

  /// As far as rounding tells: what lies in the surface's plane sees it edge-on.
  bool is_above(const Vec3& point, int surface) const {
    const double magnitude =
        std::max(targets[at(surface)].magnitude, point.lpNorm<Eigen::Infinity>());
    return scene.surfaces[at(surface)].frame.height(point) > margins::slack * magnitude;
  }

  void see_unobstructed(const SurfacePoint& point, int surface, SeenPart& seen) const {
    const Target& target = targets[at(surface)];
    seen.factor = unobstructed_factor(point.position, point.normal, target.rings);
    const auto& outer = target.rings.front();
    seen.is_whole = std::all_of(outer.begin(), outer.end(), [&](const Vec3& p) {
      return point.normal.dot(p - point.position) >= 0;
    });
    if (seen.is_whole) return;
    for (const auto& ring : target.rings)
      if (Ring part = clip(ring, point, scene.surfaces[at(surface)].frame); part.size() > 2)
        tidy(seen.rings.emplace_back(std::move(part)));
  }
};

ExactSight::ExactSight(const SoundScene& scene, const ReflectingScene& reflecting)
    : impl_(std::make_unique<Impl>(scene, reflecting)) {}
ExactSight::~ExactSight() = default;

const SoundScene& ExactSight::scene() const { return impl_->scene; }

const std::vector<int>& ExactSight::roots(int surface) const {
  return impl_->targets[at(surface)].roots;
}

SurfacePoint ExactSight::point_of(int root, const Vec3& place) const {
  const ElementTable& roots = impl_->reflecting.roots;
  const PlaneFrame& frame = impl_->scene.surfaces[at(roots.surface[at(root)])].frame;
  return {frame.foot(place), roots.normal[at(root)]};
}

std::vector<Sighted> ExactSight::may_see(const std::array<Vec3, 3>& part, int root) const {
  const auto& [scene, reflecting, opaque, targets, sighters] = *impl_;
  const int own = reflecting.roots.surface[at(root)], cell = reflecting.cells.before(root);
  std::vector<Sighted> result;
  for (int s = 0; s < static_cast<int>(targets.size()); ++s) {
    const Target& target = targets[at(s)];
    const PlaneFrame& frame = scene.surfaces[at(s)].frame;
    // Rounding puts points of a two-sided face before their own back.
    if (scene.surfaces[at(s)].plane == scene.surfaces[at(own)].plane || target.roots.empty() ||
        !reaches_above(target.rings.front(), part[0], reflecting.roots.normal[at(root)]) ||
        !reaches_above(part, frame.origin, frame.normal) ||
        std::find(target.cells.begin(), target.cells.end(), cell) == target.cells.end())
      continue;
    const std::vector<int> between = reflecting.visibility.candidates(part, target.rings.front());
    const bool is_clear = std::all_of(between.begin(), between.end(), [&](int r) {
      const int surface = reflecting.roots.surface[at(r)];
      return surface == own || surface == s;
    });
    result.push_back({s, is_clear});
  }
  return result;
}

std::vector<Sighted> ExactSight::may_see(const SurfacePoint& point) const {
  std::vector<Sighted> result;
  for (int s = 0; s < static_cast<int>(impl_->targets.size()); ++s) {
    const Surface& surface = impl_->scene.surfaces[at(s)];
    if (impl_->is_above(point.position, s) && !is_meant_in_plane(surface, point) &&
        reaches_above(impl_->targets[at(s)].rings.front(), point.position, point.normal))
      result.push_back({s, false});
  }
  return result;
}

void ExactSight::see(const SurfacePoint& point, const Sighted& target, SeenPart& seen) const {
  seen = {};
  if (!impl_->is_above(point.position, target.surface)) return;
  if (target.is_clear) return impl_->see_unobstructed(point, target.surface, seen);
  auto& [finder, part] = impl_->sighters.local();
  finder.find(point.position, point.normal, target.surface, part);
  if (part.region == Region::lit) return impl_->see_unobstructed(point, target.surface, seen);
  if (part.region != Region::penumbra) return;
  seen.factor = enclosed_factor(point.position, point.normal, part.pieces);
  const PlaneFrame& frame = impl_->scene.surfaces[at(target.surface)].frame;
  for (const auto& ring : visible_rings(part, point.position, frame)) {
    Ring& flat = seen.rings.emplace_back();
    for (const Vec3& p : ring) flat.push_back(frame.to_plane(p));
    tidy(flat);
  }
}

}  // namespace halfshade
