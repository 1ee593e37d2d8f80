#include "solver/factors/few_blockers.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr std::size_t most_shades = 40;
constexpr std::size_t most_parts = 48;
/// What is nearer to a line lies on it: relative to the target.
constexpr double nearness_of_target = 1e-11;
/// A point this near to a blocker's plane sees its edge: relative to the blocker.
constexpr double edge_on = 1e-12;
constexpr std::uint64_t lit_signature = 0x2fd08b6e51c3a497, dark_signature = 0x81e6c35a0f94d72b;
/// Borders of one shade are numbered from a multiple of this on.
constexpr std::uint32_t borders_of_shade = 1024;

}  // namespace

FewBlockers::FewBlockers(const SightScene& scene, int a, int b) : target_(scene.surfaces[at(b)]) {
  const SightSurface& own = scene.surfaces[at(a)];
  if (own.pieces.size() * target_.pieces.size() > 4) return;
  std::vector<int> blockers;
  double size = 0;
  for (const Polygon3& piece : target_.pieces) {
    const Polygon3 other = clip_to_front(piece, own.frame.origin, own.frame.normal);
    if (other.empty()) continue;
    Part& part = target_parts_.emplace_back();
    for (const Vec3& p : other) {
      part.push_back({target_.frame.to_plane(p), static_cast<std::uint32_t>(part.size())});
      size = std::max(size, (p - other.front()).norm());
    }
    for (const Polygon3& own_piece : own.pieces) {
      const Polygon3 part = clip_to_front(own_piece, target_.frame.origin, target_.frame.normal);
      if (part.empty()) continue;
      for (const int t : triangles_between(scene, part, a, other, b))
        blockers.push_back(scene.blocker_of[at(t)]);
    }
  }
  std::sort(blockers.begin(), blockers.end());
  blockers.erase(std::unique(blockers.begin(), blockers.end()), blockers.end());
  nearness_ = nearness_of_target * size;
  // Where a body lies before the target's plane as a whole, all that it covers is hidden.
  const auto is_before = [&](const Vec3& p) { return target_.frame.height(p) >= -nearness_; };
  std::vector<int> bodies;
  for (const int b : blockers) {
    const Blocker& blocker = scene.blockers[at(b)];
    if (blocker.corners.size() + 1 >= borders_of_shade) return;
    if (blocker.body < 0) {
      add(blocker);
      continue;
    }
    if (std::find(bodies.begin(), bodies.end(), blocker.body) != bodies.end()) continue;
    const ConvexBody& body = scene.bodies[at(blocker.body)];
    if (body.edges.size() < borders_of_shade &&
        std::all_of(body.vertices.begin(), body.vertices.end(), is_before)) {
      bodies.push_back(blocker.body);
      bodies_.push_back(&body);
    } else
      add(blocker);
  }
  if (shades_.size() + 3 * bodies_.size() > most_shades) return;
  is_applicable_ = true;
}

void FewBlockers::add(const Blocker& blocker) {
  const PlaneFrame& frame = target_.frame;
  Shade shade{&blocker, {blocker.normal.dot(frame.e1), blocker.normal.dot(frame.e2)},
              0,        0,
              HUGE_VAL, -HUGE_VAL};
  shade.b = blocker.normal.dot(frame.origin - blocker.corners.front());
  shade.steepness = shade.a.norm();
  for (const Part& part : target_parts_)
    for (const Corner& corner : part) {
      const double height = shade.a.dot(corner.at) + shade.b;
      shade.least = std::min(shade.least, height);
      shade.most = std::max(shade.most, height);
    }
  shades_.push_back(shade);
}

/// What lies behind the plane through the point with this normal. False if nothing of the target
/// does.
bool FewBlockers::add_plane(const Vec3& normal, const Vec3& point, double size,
                            std::uint32_t border) {
  const PlaneFrame& frame = target_.frame;
  const Vec2 a(normal.dot(frame.e1), normal.dot(frame.e2));
  const double b = normal.dot(frame.origin - point);
  const double steepness = a.norm();
  // Parallel to the target.
  if (!(steepness > edge_on * size)) return b <= 0;
  shadow_.push_back({a / steepness, b / steepness, border});
  return true;
}

/// False if it hides nothing of the target.
bool FewBlockers::make_shadow(const Shade& shade, const SurfacePoint& point, double height) {
  shadow_.clear();
  const double side = height > 0 ? 1 : -1;
  auto border = static_cast<std::uint32_t>(&shade - shades_.data() + 1) * borders_of_shade;
  // What is hidden lies beyond the shade's plane.
  const double nearest = side > 0 ? shade.most : -shade.least;
  const double farthest = side > 0 ? shade.least : -shade.most;
  const double near = nearness_ * shade.steepness;
  if (farthest >= -near) return false;
  if (nearest > near)
    shadow_.push_back({side / shade.steepness * shade.a, side / shade.steepness * shade.b, border});
  const auto& corners = shade.blocker->corners;
  Vec3 from = corners.back() - point.position;
  for (const Vec3& corner : corners) {
    const Vec3 to = corner - point.position;
    const Vec3 normal = side * from.cross(to);
    if (!add_plane(normal, point.position, normal.norm(), ++border)) return false;
    from = to;
  }
  return true;
}

/// The cone through the edges between sides that the point sees and those that it does not.
bool FewBlockers::make_shadow(const ConvexBody& body, const SurfacePoint& point,
                              std::uint32_t border) {
  shadow_.clear();
  is_front_.clear();
  for (const ConvexBody::Side& side : body.sides) {
    const Vec3 towards = point.position - side.corner;
    is_front_.push_back(side.normal.dot(towards) > edge_on * towards.norm());
  }
  for (const auto& [ends, sides] : body.edges) {
    ++border;
    const bool left = is_front_[at(sides[0])], right = is_front_[at(sides[1])];
    if (left == right) continue;
    const Vec3 from = body.vertices[at(ends[left ? 0 : 1])] - point.position;
    const Vec3 to = body.vertices[at(ends[left ? 1 : 0])] - point.position;
    const Vec3 normal = from.cross(to);
    if (!add_plane(normal, point.position, normal.norm(), border)) return false;
  }
  return !shadow_.empty();
}

void FewBlockers::split(const Part& part, const HalfPlane& plane, Part& inside,
                        Part& outside) const {
  inside.clear();
  outside.clear();
  const Corner* from = &part.back();
  double at_from = snapped(plane.height(from->at));
  for (const Corner& to : part) {
    const double at_to = snapped(plane.height(to.at));
    if (at_from <= 0) inside.push_back(*from);
    if (at_from >= 0) outside.push_back(*from);
    // Where the border passes over the line, the line takes it up.
    if (at_from < 0 && at_to > 0) {
      const Vec2 crossing = from->at + at_from / (at_from - at_to) * (to.at - from->at);
      inside.push_back({crossing, plane.border});
      outside.push_back({crossing, from->border});
    } else if (at_from > 0 && at_to < 0) {
      const Vec2 crossing = from->at + at_from / (at_from - at_to) * (to.at - from->at);
      outside.push_back({crossing, plane.border});
      inside.push_back({crossing, from->border});
    } else if (at_from == 0) {
      if (at_to > 0) inside.back().border = plane.border;
      if (at_to < 0) outside.back().border = plane.border;
    }
    from = &to;
    at_from = at_to;
  }
}

void FewBlockers::cut_off_shadow(Part& part) {
  const auto is_off = [&](const HalfPlane& plane) {
    return std::all_of(part.begin(), part.end(),
                       [&](const Corner& c) { return plane.height(c.at) > -nearness_; });
  };
  if (std::any_of(shadow_.begin(), shadow_.end(), is_off)) return next_.push_back(part);
  cut_.clear();
  rest_ = part;
  for (const HalfPlane& plane : shadow_) {
    const bool is_inside = std::all_of(rest_.begin(), rest_.end(), [&](const Corner& c) {
      return plane.height(c.at) < nearness_;
    });
    if (is_inside) continue;
    const bool is_outside = std::all_of(rest_.begin(), rest_.end(), [&](const Corner& c) {
      return plane.height(c.at) > -nearness_;
    });
    if (is_outside) return next_.push_back(part);
    split(rest_, plane, inside_, outside_);
    if (outside_.size() > 2) cut_.push_back(outside_);
    rest_.swap(inside_);
  }
  next_.insert(next_.end(), cut_.begin(), cut_.end());
}

void FewBlockers::cut_off_shadow() {
  next_.clear();
  for (Part& part : parts_) cut_off_shadow(part);
  parts_.swap(next_);
}

bool FewBlockers::factor(const SurfacePoint& point, PointFactor& factor) {
  factor = {};
  if (!(target_.frame.height(point.position) > 0) || target_parts_.empty()) return true;
  factor.unobstructed = unobstructed_factor(point.position, point.normal, target_.rings);
  if (!(factor.unobstructed > 0)) return true;
  parts_ = target_parts_;
  bool is_lit = true;
  const auto can_go_on = [&] { return !parts_.empty() && parts_.size() <= most_parts; };
  for (std::size_t k = 0; k < bodies_.size() && can_go_on(); ++k) {
    const std::size_t number = shades_.size() + k + 1;
    if (make_shadow(*bodies_[k], point, static_cast<std::uint32_t>(number) * borders_of_shade))
      cut_off_shadow();
  }
  // Fronts first: what backs of closed things hide is hidden then.
  for (const double side : {1., -1.})
    for (std::size_t k = 0; k < shades_.size() && can_go_on(); ++k) {
      const Blocker& blocker = *shades_[k].blocker;
      const Vec3 towards = point.position - blocker.corners.front();
      const double height = blocker.normal.dot(towards);
      if (height * side > edge_on * towards.norm() && make_shadow(shades_[k], point, height))
        cut_off_shadow();
    }
  if (parts_.size() > most_parts) return false;
  if (parts_.empty()) {
    factor.region = Region::umbra;
    factor.signature = dark_signature;
    return true;
  }
  for (const Part& part : parts_)
    for (const Corner& corner : part) is_lit = is_lit && corner.border < borders_of_shade;
  if (is_lit) {
    factor.region = Region::lit;
    factor.signature = lit_signature;
    factor.visible = factor.unobstructed;
    return true;
  }
  factor.region = Region::penumbra;
  EdgeSum sum(target_.frame.to_space(parts_.front().front().at) - point.position);
  for (const Part& part : parts_) {
    const Corner *before = &part[part.size() - 2], *from = &part.back();
    Vec3 a = target_.frame.to_space(from->at) - point.position;
    for (const Corner& to : part) {
      const Vec3 b = target_.frame.to_space(to.at) - point.position;
      sum.add(a, b);
      a = b;
      factor.signature += mix_bits(
          mix_bits((static_cast<std::uint64_t>(before->border) << 32) + from->border) + to.border);
      before = from;
      from = &to;
    }
  }
  factor.visible = std::clamp(sum.form_factor(point.normal), 0., factor.unobstructed);
  return true;
}

}  // namespace halfshade
