#include "meshing/discontinuity/sight_casting.h"

#include "meshing/discontinuity/margins.h"
#include "meshing/events/margins.h"
#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Whether a line misses a box that is a little enlarged.
class RayBoxTest {
 public:
  explicit RayBoxTest(const SightLine& line)
      : origin_(line.start),
        inverse_(line.direction.cwiseInverse()),
        slack_(margins::box_growth *
               std::max(margins::slack_at(line.start), margins::slack_at(line.last))) {}

  bool misses(const Bounds& box) const {
    double near = -slack_, far = HUGE_VAL;
    for (Eigen::Index k = 0; k < 3; ++k) {
      double a = (box.low[k] - slack_ - origin_[k]) * inverse_[k];
      double b = (box.high[k] + slack_ - origin_[k]) * inverse_[k];
      if (std::isnan(a) || std::isnan(b)) continue;  // along a face of the box
      if (a > b) std::swap(a, b);
      near = std::max(near, a);
      far = std::min(far, b);
    }
    return near > far;
  }

 private:
  Vec3 origin_, inverse_;
  double slack_;
};

}  // namespace

SightCaster::SightCaster(const SoundScene& scene, const OpaqueScene& opaque)
    : scene_(scene), opaque_(opaque.topology()), faces_(opaque.face_tree()) {
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    if (!surface.back) continue;
    if (at(surface.plane) >= backs_.size()) backs_.resize(at(surface.plane) + 1);
    backs_[at(surface.plane)].push_back(static_cast<int>(s));
  }
}

const std::vector<int>& SightCaster::cast(const SightLine& line) {
  find_crossings(line);
  collect_receivers(line);
  return reached_;
}

void SightCaster::find_crossings(const SightLine& line) {
  crossings_.clear();
  steps_ = 0;
  const RayBoxTest ray(line);
  walk_tree(
      faces_,
      [&](int node) {
        ++steps_;
        return ray.misses(faces_.nodes[at(node)].box);
      },
      [&](int t) {
        ++steps_;
        // Seen from the last feature, near which it is decided what blocks and what receives.
        const auto& corner = opaque_.triangles[at(t)].corner;
        const Vec3 a = opaque_.vertices[at(corner[0])] - line.last;
        const Vec3 b = opaque_.vertices[at(corner[1])] - line.last;
        const Vec3 c = opaque_.vertices[at(corner[2])] - line.last;
        const Vec3 normal = (b - a).cross(c - a);
        const double across = normal.dot(line.direction), size = normal.norm();
        if (!(std::abs(across) > margins::grazing_sine * size)) return;
        const double u = b.cross(c).dot(line.direction) / across;
        const double v = c.cross(a).dot(line.direction) / across;
        const double least = std::min({u, v, 1 - u - v});
        if (least < -margins::clearly_inside) return;
        const int surface = opaque_.triangles[at(t)].surface;
        const double slack =
            std::max(margins::slack_at(line.last), opaque_.surfaces[at(surface)].tolerance.length);
        crossings_.push_back({normal.dot(a) / across, slack, t, least > margins::clearly_inside});
      });
  std::sort(crossings_.begin(), crossings_.end(), [](const Crossing& a, const Crossing& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
}

void SightCaster::collect_receivers(const SightLine& line) {
  reached_.clear();
  blockers_.clear();
  const double start = line.direction.dot(line.start - line.last);
  const double start_slack = margins::slack_at(line.start);
  const Crossing* end = nullptr;
  for (const Crossing& crossing : crossings_) {
    // Of two faces back to back, rounding says which comes first.
    if (end && !is_as_near(crossing, *end)) continue;
    if (crossing.distance < start + std::max(start_slack, crossing.slack)) continue;
    const bool is_before = crossing.distance < -crossing.slack;
    if (is_before && crossing.is_clear) blockers_.push_back(crossing.triangle);
    if (!blockers_.empty()) continue;
    if (crossing.distance <= crossing.slack) continue;
    add_receiver(opaque_.triangles[at(crossing.triangle)].surface, line.direction);
    if (crossing.is_clear && !end) end = &crossing;
  }
}

/// Whether the line meets a triangle where it meets one before, but for rounding. In their common
/// plane they may lie farther apart than the slack if the line runs along it.
bool SightCaster::is_as_near(const Crossing& crossing, const Crossing& before) const {
  const auto plane = [&](const Crossing& c) {
    return scene_.surfaces[at(opaque_.triangles[at(c.triangle)].surface)].plane;
  };
  return crossing.distance <= before.distance + std::max(crossing.slack, before.slack) ||
         plane(crossing) == plane(before);
}

/// Adds a surface if it faces the line, else those on the back of its plane that do.
void SightCaster::add_receiver(int surface, const Vec3& direction) {
  const auto faces_line = [&](int s) {
    return scene_.surfaces[at(s)].frame.normal.dot(direction) < 0;
  };
  const auto add = [&](int s) {
    if (std::find(reached_.begin(), reached_.end(), s) == reached_.end()) reached_.push_back(s);
  };
  if (faces_line(surface)) return add(surface);
  const std::size_t plane = at(scene_.surfaces[at(surface)].plane);
  if (plane >= backs_.size()) return;
  for (const int back : backs_[plane])
    if (faces_line(back)) add(back);
}

}  // namespace halfshade
