#include "meshing/discontinuity/border_events.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/core/planar.h"
#include "meshing/discontinuity/rounding.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

// The sine of the angle below which a receiver does not cross the emitter's plane.
constexpr double parallel = 1e-9;
// Contact lines with a smaller jump of the form factor, absolute, are none.
constexpr double least_jump = 1e-9;
// Places along a contact line at which a jump is looked for.
constexpr int contact_samples = 8;

/// Parameters along the line origin + t·along inside a receiver, as pairs.
std::vector<std::array<double, 2>> stretches(const Surface& receiver, const Vec2& origin,
                                             const Vec2& along) {
  std::vector<double> hits;
  for (const Ring& ring : receiver.rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 a = ring[k] - origin, b = ring[(k + 1) % ring.size()] - origin;
      const double sa = cross_2d(along, a), sb = cross_2d(along, b);
      if ((sa > 0) == (sb > 0)) continue;
      hits.push_back(along.dot(a + sa / (sa - sb) * (b - a)) / along.squaredNorm());
    }
  std::sort(hits.begin(), hits.end());
  std::vector<std::array<double, 2>> result;
  for (std::size_t k = 1; k < hits.size(); k += 2) result.push_back({hits[k - 1], hits[k]});
  return result;
}

/// Points of the emitter's plane that can limit what is seen along it.
std::vector<Vec3> limits_in_plane(const OpaqueTopology& opaque, const EmitterScene& emitter_scene) {
  std::vector<Vec3> points;
  for (const auto& edge : opaque.edges) {
    const Vec3 &from = opaque.vertices[at(edge.from)], &to = opaque.vertices[at(edge.to)];
    const double a = emitter_scene.frame.height(from), b = emitter_scene.frame.height(to);
    if (std::max(a, b) <= emitter_scene.slack || std::min(a, b) >= -emitter_scene.slack) {
      if (std::abs(a) <= emitter_scene.slack) points.push_back(from);
      if (std::abs(b) <= emitter_scene.slack) points.push_back(to);
    } else {
      points.push_back(from + a / (a - b) * (to - from));
    }
  }
  return points;
}

}  // namespace

void emitter_plane_curves(const SoundScene& scene, const OpaqueScene& opaque,
                          const EmitterScene& emitter_scene, int receiver,
                          std::vector<DiscontinuityCurve>& curves) {
  const Surface& target = scene.surfaces[at(receiver)];
  const Vec3 direction = target.frame.normal.cross(emitter_scene.frame.normal);
  if (direction.norm() < parallel || receiver == emitter_scene.emitter) return;
  // A point of both planes: from the receiver's origin down its steepest line.
  const Vec3 steepest = direction.cross(target.frame.normal);
  const Vec3 origin = target.frame.origin - emitter_scene.frame.height(target.frame.origin) /
                                                emitter_scene.frame.normal.dot(steepest) * steepest;
  const Vec2 start = target.frame.to_plane(origin);
  const Vec2 along = target.frame.to_plane(origin + direction.normalized()) - start;
  const auto inside = stretches(target, start, along);
  if (inside.empty()) return;
  std::vector<double> cuts;
  const std::vector<Vec3> limits = limits_in_plane(opaque.topology(), emitter_scene);
  std::vector<Vec2> apexes;
  for (const OutlinePoint& corner : emitter_scene.corners)
    apexes.push_back(emitter_scene.frame.to_plane(corner.position));
  const Vec2 p = emitter_scene.frame.to_plane(origin);
  const Vec2 u = emitter_scene.frame.to_plane(origin + direction.normalized()) - p;
  for (const Vec3& limit : limits) {
    const Vec2 y = emitter_scene.frame.to_plane(limit);
    for (const Vec2& apex : apexes)
      cuts.push_back(cross_2d(apex - p, y - apex) / cross_2d(u, y - apex));
  }
  // Into the half-space in front of the emitter.
  const Vec3 left3 = target.frame.normal.cross(direction.normalized());
  const double ahead = emitter_scene.frame.normal.dot(left3) > 0 ? 1 : -1;
  const double step = side_step(scene, opaque);
  VisiblePartFinder finder(opaque);
  VisiblePart part;
  for (const auto& [t0, t1] : inside) {
    std::vector<double> t = {t0, t1};
    for (const double cut : cuts)
      if (cut > t0 && cut < t1) t.push_back(cut);
    std::sort(t.begin(), t.end());
    for (std::size_t k = 1; k < t.size(); ++k) {
      if (t[k] - t[k - 1] < 4 * step) continue;
      const double middle = 0.5 * (t[k - 1] + t[k]);
      const Vec3 point = target.frame.to_space(start + middle * along) + ahead * step * left3;
      finder.find(point, target.frame.normal, emitter_scene.emitter, part);
      if (part.region == Region::umbra || part.region == Region::away) continue;
      if (!curves.empty() && curves.back().receiver == receiver &&
          curves.back().sources[0].features[0].id == emitter_scene.emitter &&
          (curves.back().arc.to - (start + t[k - 1] * along)).norm() <= step) {
        curves.back().arc = straight_arc(curves.back().arc.from, start + t[k] * along);
        continue;
      }
      DiscontinuityCurve curve;
      curve.receiver = receiver;
      curve.emitter = emitter_scene.emitter;
      curve.kind = CurveKind::face;
      curve.order = 1;
      curve.arc = straight_arc(start + t[k - 1] * along, start + t[k] * along);
      curve.sight_plane = emitter_scene.frame.normal;
      curve.sources = {{CurveKind::face, {Feature{Feature::Kind::face, emitter_scene.emitter}}, 1}};
      curves.push_back(std::move(curve));
    }
  }
}

void contact_curves(const SoundScene& scene, const OpaqueScene& opaque,
                    const EmitterScene& emitter_scene, int receiver,
                    std::vector<DiscontinuityCurve>& curves) {
  const Surface& target = scene.surfaces[at(receiver)];
  const double step = side_step(scene, opaque);
  VisiblePartFinder finder(opaque);
  VisiblePart part;
  for (const Segment2& contact : target.contacts) {
    const Vec2 along = contact[1] - contact[0], left = Vec2(-along.y(), along.x()).normalized();
    const auto factor = [&](const Vec2& p) {
      const Vec3 point = target.frame.to_space(p);
      finder.find(point, target.frame.normal, emitter_scene.emitter, part);
      return enclosed_factor(point, target.frame.normal, part.pieces);
    };
    bool jumps = false;
    for (int k = 0; k < contact_samples && !jumps; ++k) {
      const Vec2 p = contact[0] + (k + 0.5) / contact_samples * along;
      jumps = std::abs(factor(p + step * left) - factor(p - step * left)) > least_jump;
    }
    if (!jumps) continue;
    DiscontinuityCurve curve;
    curve.receiver = receiver;
    curve.emitter = emitter_scene.emitter;
    curve.kind = CurveKind::contact;
    curve.order = 0;
    curve.arc = straight_arc(contact[0], contact[1]);
    curve.sources = {{CurveKind::contact, {}, 0}};
    curves.push_back(std::move(curve));
  }
}

}  // namespace halfshade
