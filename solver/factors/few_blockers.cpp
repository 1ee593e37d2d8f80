#include "solver/factors/few_blockers.h"

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

/// At most √2 times the length, and a good deal quicker.
double length_about(const Vec2& a) { return std::abs(a.x()) + std::abs(a.y()); }
double length_about(const Vec3& a) { return std::abs(a.x()) + std::abs(a.y()) + std::abs(a.z()); }

}  // namespace

void FewBlockers::Parts::clear() {
  corners.clear();
  ends.clear();
}

void FewBlockers::Parts::add(const Corner* first, const Corner* last) {
  corners.insert(corners.end(), first, last);
  ends.push_back(corners.size());
}

Vec3 FewBlockers::turned(const Vec3& direction) const {
  const PlaneFrame& frame = target_.frame;
  return {frame.e1.dot(direction), frame.e2.dot(direction), frame.normal.dot(direction)};
}

Vec3 FewBlockers::in_frame(const Vec3& point) const { return turned(point - target_.frame.origin); }

FewBlockers::FewBlockers(const SightScene& scene, int a, int b) : target_(scene.surfaces[at(b)]) {
  const SightSurface& own = scene.surfaces[at(a)];
  if (own.pieces.size() * target_.pieces.size() > 4) return;
  normal_ = turned(own.frame.normal);
  std::vector<int> blockers;
  double size = 0;
  for (const Polygon3& piece : target_.pieces) {
    const Polygon3 other = clip_to_front(piece, own.frame.origin, own.frame.normal);
    if (other.empty()) continue;
    Part part;
    for (const Vec3& p : other) {
      part.push_back({target_.frame.to_plane(p), static_cast<std::uint32_t>(part.size())});
      size = std::max(size, (p - other.front()).norm());
    }
    target_parts_.add(part.data(), part.data() + part.size());
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
      add(body);
    } else
      add(blocker);
  }
  if (shades_.size() + 3 * solids_.size() > most_shades) return;
  is_applicable_ = true;
}

void FewBlockers::add(const Blocker& blocker) {
  Shade shade;
  for (const Vec3& corner : blocker.corners) shade.corners.push_back(in_frame(corner));
  shade.normal = turned(blocker.normal);
  shade.a = shade.normal.head<2>();
  shade.b = -shade.normal.dot(shade.corners.front());
  shade.steepness = shade.a.norm();
  shade.least = HUGE_VAL;
  shade.most = -HUGE_VAL;
  for (const Corner& corner : target_parts_.corners) {
    const double height = shade.a.dot(corner.at) + shade.b;
    shade.least = std::min(shade.least, height);
    shade.most = std::max(shade.most, height);
  }
  shades_.push_back(std::move(shade));
}

void FewBlockers::add(const ConvexBody& body) {
  Solid solid{&body, {}, {}, {}};
  for (const Vec3& p : body.vertices) solid.vertices.push_back(in_frame(p));
  for (const ConvexBody::Side& side : body.sides) {
    solid.corners.push_back(in_frame(side.corner));
    solid.normals.push_back(turned(side.normal));
  }
  solids_.push_back(std::move(solid));
}

/// What lies behind the plane through the point and an edge, both ends relative to the point. False
/// if nothing of the target does.
bool FewBlockers::add_plane(const Vec3& from, const Vec3& to, std::uint32_t border) {
  const Vec3 normal = from.cross(to);
  const Vec2 a = normal.head<2>();
  const double b = -normal.dot(point_), steepness = length_about(a);
  // Parallel to the target.
  if (!(steepness > edge_on * length_about(normal))) return b <= 0;
  shadow_.push_back({a, b, nearness_ * steepness, border});
  return true;
}

/// False if it hides nothing of the target.
bool FewBlockers::make_shadow(const Shade& shade, double height, std::uint32_t border) {
  shadow_.clear();
  const double side = height > 0 ? 1 : -1;
  // What is hidden lies beyond the shade's plane.
  const double nearest = side > 0 ? shade.most : -shade.least;
  const double farthest = side > 0 ? shade.least : -shade.most;
  const double near = nearness_ * shade.steepness;
  if (farthest >= -near) return false;
  if (nearest > near) shadow_.push_back({side * shade.a, side * shade.b, near, border});
  Vec3 from = shade.corners.back() - point_;
  for (const Vec3& corner : shade.corners) {
    const Vec3 to = corner - point_;
    ++border;
    if (!(side > 0 ? add_plane(from, to, border) : add_plane(to, from, border))) return false;
    from = to;
  }
  return true;
}

/// The cone through the edges between sides that the point sees and those that it does not.
bool FewBlockers::make_shadow(const Solid& solid, std::uint32_t border) {
  shadow_.clear();
  is_front_.clear();
  for (std::size_t k = 0; k < solid.corners.size(); ++k) {
    const Vec3 towards = point_ - solid.corners[k];
    is_front_.push_back(solid.normals[k].dot(towards) > edge_on * length_about(towards));
  }
  for (const auto& [ends, sides] : solid.body->edges) {
    ++border;
    const bool left = is_front_[at(sides[0])], right = is_front_[at(sides[1])];
    if (left == right) continue;
    if (!add_plane(solid.vertices[at(ends[left ? 0 : 1])] - point_,
                   solid.vertices[at(ends[left ? 1 : 0])] - point_, border))
      return false;
  }
  return !shadow_.empty();
}

double FewBlockers::sum_over(const Corner* first, const Corner* last) const {
  FlatSum sum(point_, normal_);
  sum.start((last - 1)->at);
  for (; first != last; ++first) sum.add(first->at);
  return sum.form_factor();
}

void FewBlockers::add_hidden(const Part& part, HiddenFactor& factor) const {
  factor.hidden += sum_over(part.data(), part.data() + part.size());
  std::uint32_t before = part[part.size() - 2].border, from = part.back().border;
  for (const Corner& to : part) {
    factor.signature +=
        mix_bits(mix_bits((static_cast<std::uint64_t>(before) << 32) + from) + to.border);
    before = from;
    from = to.border;
  }
}

/// Of one part: what lies outside of the shadow goes to the next parts, what is left is hidden.
void FewBlockers::cut_off_shadow(const Corner* first, const Corner* last, HiddenFactor& factor) {
  const auto is_off = [&](const HalfPlane& plane) {
    return std::all_of(first, last, [&](const Corner& c) { return plane.height(c.at) >= 0; });
  };
  if (std::any_of(shadow_.begin(), shadow_.end(), is_off)) return next_.add(first, last);
  const std::size_t corners_before = next_.corners.size(), parts_before = next_.ends.size();
  rest_.assign(first, last);
  for (const HalfPlane& plane : shadow_) {
    heights_.clear();
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (const Corner& corner : rest_) {
      heights_.push_back(plane.height(corner.at));
      least = std::min(least, heights_.back());
      most = std::max(most, heights_.back());
    }
    if (most <= 0) continue;
    if (least >= 0) {
      next_.corners.resize(corners_before);
      next_.ends.resize(parts_before);
      return next_.add(first, last);
    }
    inside_.clear();
    const std::size_t start = next_.corners.size();
    Part& outside = next_.corners;
    const Corner* from = &rest_.back();
    double at_from = heights_.back();
    for (std::size_t k = 0; k < rest_.size(); ++k) {
      const Corner& to = rest_[k];
      const double at_to = heights_[k];
      if (at_from <= 0) inside_.push_back(*from);
      if (at_from >= 0) outside.push_back(*from);
      // Where the border passes over the line, the line takes it up.
      if (at_from < 0 && at_to > 0) {
        const Vec2 crossing = from->at + at_from / (at_from - at_to) * (to.at - from->at);
        inside_.push_back({crossing, plane.border});
        outside.push_back({crossing, from->border});
      } else if (at_from > 0 && at_to < 0) {
        const Vec2 crossing = from->at + at_from / (at_from - at_to) * (to.at - from->at);
        outside.push_back({crossing, plane.border});
        inside_.push_back({crossing, from->border});
      } else if (at_from == 0) {
        if (at_to > 0) inside_.back().border = plane.border;
        if (at_to < 0) outside.back().border = plane.border;
      }
      from = &to;
      at_from = at_to;
    }
    if (outside.size() > start + 2)
      next_.ends.push_back(outside.size());
    else
      outside.resize(start);
    rest_.swap(inside_);
  }
  if (rest_.size() > 2) add_hidden(rest_, factor);
}

void FewBlockers::cut_off_shadow(HiddenFactor& factor) {
  next_.clear();
  std::size_t first = 0;
  for (const std::size_t end : parts_.ends) {
    cut_off_shadow(parts_.corners.data() + first, parts_.corners.data() + end, factor);
    first = end;
  }
  std::swap(parts_, next_);
}

bool FewBlockers::factor(const Vec3& point, HiddenFactor& factor) {
  factor = {};
  if (!(target_.frame.height(point) > 0) || target_parts_.ends.empty()) return true;
  point_ = in_frame(point);
  std::size_t first = 0;
  for (const std::size_t end : target_parts_.ends) {
    const Corner* corners = target_parts_.corners.data();
    factor.unobstructed += sum_over(corners + first, corners + end);
    first = end;
  }
  if (!(factor.unobstructed > 0)) {
    factor.unobstructed = 0;
    return true;
  }
  parts_.corners = target_parts_.corners;
  parts_.ends = target_parts_.ends;
  const auto can_go_on = [&] { return !parts_.ends.empty() && parts_.ends.size() <= most_parts; };
  std::uint32_t border = 0;
  for (std::size_t k = 0; k < solids_.size() && can_go_on(); ++k)
    if (make_shadow(solids_[k], border += borders_of_shade)) cut_off_shadow(factor);
  // Fronts first: what backs of closed things hide is hidden then.
  for (const double side : {1., -1.})
    for (std::size_t k = 0; k < shades_.size() && can_go_on(); ++k) {
      const Shade& shade = shades_[k];
      const Vec3 towards = point_ - shade.corners.front();
      const double height = shade.normal.dot(towards);
      const auto number = static_cast<std::uint32_t>(solids_.size() + k + 1);
      if (height * side > edge_on * length_about(towards) &&
          make_shadow(shade, height, number * borders_of_shade))
        cut_off_shadow(factor);
    }
  if (parts_.ends.size() > most_parts) return false;
  factor.is_dark = parts_.ends.empty();
  if (factor.is_dark) {
    factor.signature = dark_signature;
    factor.hidden = factor.unobstructed;
    return true;
  }
  if (factor.signature == 0) factor.signature = lit_signature;
  factor.hidden = std::clamp(factor.hidden, 0., factor.unobstructed);
  return true;
}

}  // namespace halfshade
