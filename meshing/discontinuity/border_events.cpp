#include "meshing/discontinuity/border_events.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/core/planar.h"
#include "meshing/discontinuity/margins.h"
#include "meshing/discontinuity/stretches.h"
#include "meshing/events/margins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace halfshade {
namespace {

// Places along a contact line at which a jump is looked for.
constexpr int contact_samples = 8;

/// Points of the emitter's plane, in its frame, that can limit what is seen along it.
std::vector<Vec2> limits_in_plane(const OpaqueTopology& opaque, const EmitterScene& emitter_scene) {
  const PlaneFrame& plane = emitter_scene.frame;
  std::vector<Vec2> points;
  const auto add = [&](const Vec3& point) { points.push_back(plane.to_plane(point)); };
  for (const auto& edge : opaque.edges) {
    const Vec3 &from = opaque.vertices[at(edge.from)], &to = opaque.vertices[at(edge.to)];
    const double a = plane.height(from), b = plane.height(to);
    const double slack = std::max(emitter_scene.slack, margins::slack_of({from, to}));
    if (std::max(a, b) <= slack || std::min(a, b) >= -slack) {
      if (std::abs(a) <= slack) add(from);
      if (std::abs(b) <= slack) add(to);
    } else {
      add(from + a / (a - b) * (to - from));
    }
  }
  return points;
}

/// The line in which the planes of a receiver and the emitter meet.
struct CommonLine {
  Vec3 origin, direction;  ///< the latter of unit length
  Vec2 start, along;       ///< the same in the receiver's frame
};

std::optional<CommonLine> common_line(const PlaneFrame& receiver, const PlaneFrame& emitter) {
  const Vec3 direction = receiver.normal.cross(emitter.normal);
  if (direction.norm() < margins::grazing_sine) return std::nullopt;
  // A point of both planes: from the receiver's origin down its steepest line.
  const Vec3 steepest = direction.cross(receiver.normal);
  CommonLine line;
  line.origin =
      receiver.origin - emitter.height(receiver.origin) / emitter.normal.dot(steepest) * steepest;
  line.direction = direction.normalized();
  line.start = receiver.to_plane(line.origin);
  line.along = {receiver.e1.dot(line.direction), receiver.e2.dot(line.direction)};
  return line;
}

/// Parameters along a range of the line, with its ends and sorted, between which the view of the
/// emitter's corners, along its plane, is limited by the same things. A limit matters if it is
/// between a corner and the line, or beyond the line by less than the slack, a length.
std::vector<double> view_limits(std::span<const Vec2> limits, const EmitterScene& emitter_scene,
                                const CommonLine& line, const std::array<double, 2>& range,
                                double slack) {
  const PlaneFrame& plane = emitter_scene.frame;
  const Vec2 start = plane.to_plane(line.origin);
  const Vec2 u(plane.e1.dot(line.direction), plane.e2.dot(line.direction));
  std::vector<double> cuts = {range[0], range[1]};
  for (const OutlinePoint& corner : emitter_scene.corners) {
    const Vec2 apex = plane.to_plane(corner.position), back = apex - start;
    for (const Vec2& limit : limits) {
      const Vec2 onwards = limit - apex;
      const double cut = cross_2d(back, onwards) / cross_2d(u, onwards);
      if (!(cut > range[0] && cut < range[1])) continue;
      const Vec2 sight = cut * u - back;
      if (onwards.dot(sight) > 0 && onwards.norm() <= sight.norm() + slack) cuts.push_back(cut);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// Appends a piece of the line in which a receiver meets the emitter's plane, or makes the last
/// curve longer if that is such a piece and ends within a side step of this one.
void append_plane_curve(const EmitterScene& emitter_scene, int receiver, const Vec2& from,
                        const Vec2& to, double step, std::vector<DiscontinuityCurve>& curves) {
  const CurveSource source = {
      CurveKind::face, {Feature{Feature::Kind::face, emitter_scene.emitter}}, 1};
  if (!curves.empty() && curves.back().receiver == receiver && curves.back().sources[0] == source &&
      (curves.back().arc.to - from).norm() <= step) {
    curves.back().arc = straight_arc(curves.back().arc.from, to);
    return;
  }
  DiscontinuityCurve curve;
  curve.receiver = receiver;
  curve.emitter = emitter_scene.emitter;
  curve.kind = CurveKind::face;
  curve.order = 1;
  curve.step = step;
  curve.arc = straight_arc(from, to);
  curve.sight_plane = emitter_scene.frame.normal;
  curve.sources = {source};
  curves.push_back(std::move(curve));
}

}  // namespace

BorderSearch::BorderSearch(const SoundScene& scene, const OpaqueScene& opaque,
                           const EmitterScene& emitter_scene)
    : scene_(scene),
      emitter_scene_(emitter_scene),
      limits_(limits_in_plane(opaque.topology(), emitter_scene)),
      finder_(opaque) {}

/// Sees the emitter from a point of a receiver.
const VisiblePart& BorderSearch::look(const Vec3& point, const Surface& receiver) {
  finder_.find(point, receiver.frame.normal, emitter_scene_.emitter, part_);
  return part_;
}

bool BorderSearch::add_plane_curves(int receiver, double most_work,
                                    std::vector<DiscontinuityCurve>& curves) {
  if (receiver == emitter_scene_.emitter) return true;
  const Surface& target = scene_.surfaces[at(receiver)];
  const std::optional<CommonLine> line = common_line(target.frame, emitter_scene_.frame);
  if (!line) return true;
  const auto inside = stretches(target, line->start, line->along);
  if (inside.empty()) return true;
  // Into the half-space in front of the emitter.
  const Vec3 left = target.frame.normal.cross(line->direction);
  const double ahead = emitter_scene_.frame.normal.dot(left) > 0 ? 1 : -1;
  const double step = side_step(target);
  const auto place = [&](double t) -> Vec2 { return line->start + t * line->along; };
  const SightEffort before = effort();
  for (const auto& range : inside) {
    const std::vector<double> t = view_limits(limits_, emitter_scene_, *line, range, step);
    for (std::size_t k = 1; k < t.size(); ++k) {
      if (t[k] - t[k - 1] < margins::least_steps * step) continue;
      if (work_of(effort() - before) > most_work) return false;
      const Vec3 point =
          target.frame.to_space(place(0.5 * (t[k - 1] + t[k]))) + ahead * step * left;
      const Region region = look(point, target).region;
      if (region == Region::umbra || region == Region::away) continue;
      append_plane_curve(emitter_scene_, receiver, place(t[k - 1]), place(t[k]), step, curves);
    }
  }
  return true;
}

bool BorderSearch::add_contact_curves(int receiver, double most_work,
                                      std::vector<DiscontinuityCurve>& curves) {
  const Surface& target = scene_.surfaces[at(receiver)];
  const double step = side_step(target);
  const auto factor = [&](const Vec2& p) {
    const Vec3 point = target.frame.to_space(p);
    return enclosed_factor(point, target.frame.normal, look(point, target).pieces);
  };
  const SightEffort before = effort();
  for (const Segment2& contact : target.contacts) {
    if (work_of(effort() - before) > most_work) return false;
    const Vec2 along = contact[1] - contact[0], left = Vec2(-along.y(), along.x()).normalized();
    bool jumps = false;
    for (int k = 0; k < contact_samples && !jumps; ++k) {
      const Vec2 p = contact[0] + (k + 0.5) / contact_samples * along;
      jumps = std::abs(factor(p + step * left) - factor(p - step * left)) > margins::least_jump;
    }
    if (!jumps) continue;
    DiscontinuityCurve curve;
    curve.receiver = receiver;
    curve.emitter = emitter_scene_.emitter;
    curve.kind = CurveKind::contact;
    curve.order = 0;
    curve.step = step;
    curve.arc = straight_arc(contact[0], contact[1]);
    curve.sources = {{CurveKind::contact, {}, 0}};
    curves.push_back(std::move(curve));
  }
  return true;
}

}  // namespace halfshade
