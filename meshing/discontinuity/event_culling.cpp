#include "meshing/discontinuity/event_culling.h"

#include "meshing/discontinuity/discontinuity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

// One line of a piece decides for all, so that less than the limit must count.
constexpr double least_share_of_limit = 0.25;

}  // namespace

bool may_be_event(const EmitterScene& emitter_scene, const Swath& swath, const SightLine& line) {
  if (!(swath.ends_on_outline || emitter_scene.contains(line.start))) return false;
  const auto may_be = [&](int e) {
    return emitter_scene.may_be_silhouette(emitter_scene.edges[at(e)], line.direction);
  };
  for (const int e : swath.silhouettes)
    if (e >= 0 && !may_be(e)) return false;
  if (swath.corner < 0) return true;
  const std::vector<int>& edges = emitter_scene.vertices[at(swath.corner)].edges;
  return std::count_if(edges.begin(), edges.end(), may_be) >= 2;
}

EventCulling::EventCulling(const SoundScene& scene, const OpaqueScene& opaque,
                           const EmitterScene& emitter_scene, const TraceLimits& limits)
    : opaque_(opaque.topology()), emitter_scene_(emitter_scene), limits_(limits) {
  for (const Surface& surface : scene.surfaces) receiver_size_.push_back(size_of(surface));
}

bool EventCulling::may_matter(const Swath& swath, const SightLine& line, int receiver,
                              const ReceivingPoint& at) const {
  if (!(limits_.least_change > 0)) return true;
  if (!factor_may_matter(at.position)) return false;
  const double size = element_size(receiver_size_[halfshade::at(receiver)], limits_.max_length);
  return swath.may_be_first_order ? slope_may_matter(line, at, size)
                                  : curvature_may_matter(swath, at, size);
}

/// The form factor is at most the emitter's area times the largest kernel.
bool EventCulling::factor_may_matter(const Vec3& point) const {
  const Vec2 in_plane = emitter_scene_.frame.to_plane(point);
  Vec2 nearest = in_plane;
  for (Eigen::Index k = 0; k < 2; ++k)
    nearest[k] =
        std::clamp(in_plane[k], emitter_scene_.bounds.min()[k], emitter_scene_.bounds.max()[k]);
  const double height = emitter_scene_.frame.height(point);
  const double distance = std::hypot(height, (nearest - in_plane).norm());
  return !(emitter_scene_.area * height <
           limits_.least_change * std::numbers::pi * std::pow(distance, 3));
}

/// The slope jumps by no more than a shadow's straight edge across all of the emitter makes it,
/// moving as its nearest point does.
bool EventCulling::slope_may_matter(const SightLine& line, const ReceivingPoint& at,
                                    double size) const {
  const Vec3 way = line.start - at.position;
  const double kernel = std::abs(at.normal.dot(way) * emitter_scene_.frame.normal.dot(way)) /
                        (std::numbers::pi * std::pow(way.squaredNorm(), 2));
  const double speed = (line.start - line.last).norm() / (line.last - at.position).norm();
  const double jump = kernel * speed * emitter_scene_.bounds.diagonal().norm();
  return jump * size >= least_share_of_limit * limits_.least_change;
}

/// The curvature jumps by what three of the swath's edges make.
bool EventCulling::curvature_may_matter(const Swath& swath, const ReceivingPoint& at,
                                        double size) const {
  const auto& ids = swath.group;
  for (std::size_t i = 0; i < ids.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k) {
        const double jump = triangle_jump(
            at, emitter_scene_.frame,
            {line_of(emitter_scene_, opaque_, ids[i]), line_of(emitter_scene_, opaque_, ids[j]),
             line_of(emitter_scene_, opaque_, ids[k])});
        if (!(0.5 * jump * size * size < least_share_of_limit * limits_.least_change)) return true;
      }
  return false;
}

}  // namespace halfshade
