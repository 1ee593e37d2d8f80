#include "solver/factors/few_blockers.h"

#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr std::size_t most_shades = 100;
constexpr std::size_t most_parts = 48;
/// What is nearer to a line lies on it: relative to the target.
constexpr double nearness_of_target = 1e-11;
/// A point this near to a blocker's plane sees its edge: relative to the blocker.
constexpr double edge_on = 1e-12;
/// Targets that fill more of the view, as the sine of half the angle, are not asked what lies
/// beside them; and balls count as larger by what rounding is.
constexpr double nearly_all_round = 0.99, slightly_more = 1 + 1e-9;
constexpr std::uint64_t lit_signature = 0x2fd08b6e51c3a497, dark_signature = 0x81e6c35a0f94d72b;
/// Borders of one shade are numbered from a multiple of this on.
constexpr std::uint32_t borders_of_shade = 1024;

/// At most √2 times the length, and a good deal quicker.
double length_about(const Vec2& a) { return std::abs(a.x()) + std::abs(a.y()); }
double length_about(const Vec3& a) { return std::abs(a.x()) + std::abs(a.y()) + std::abs(a.z()); }

Vec3 turned(const PlaneFrame& frame, const Vec3& direction) {
  return {frame.e1.dot(direction), frame.e2.dot(direction), frame.normal.dot(direction)};
}

}  // namespace

FewBlockers::FewBlockers(const SightScene& scene, int a, int b, std::vector<int> blockers)
    : target_(scene.surfaces[at(b)]) {
  const SightSurface& own = scene.surfaces[at(a)];
  if (own.pieces.size() * target_.pieces.size() > 4) return;
  normal_ = turned(target_.frame, own.frame.normal);
  const bool is_known = !blockers.empty();
  double size = 0;
  for (const Polygon3& piece : target_.pieces) {
    const Polygon3 other = clip_to_front(piece, own.frame.origin, own.frame.normal);
    if (other.empty()) continue;
    const std::size_t first = target_corners_.size();
    for (const Vec3& p : other) {
      const std::size_t number = target_corners_.size() - first;
      target_corners_.push_back({target_.frame.to_plane(p), static_cast<std::uint32_t>(number)});
      size = std::max(size, (p - other.front()).norm());
    }
    target_parts_.push_back({first, target_corners_.size()});
    if (is_known) continue;
    for (const Polygon3& own_piece : own.pieces) {
      const Polygon3 part = clip_to_front(own_piece, target_.frame.origin, target_.frame.normal);
      if (part.empty()) continue;
      for (const int t : triangles_between(scene, part, a, other, b))
        blockers.push_back(scene.blocker_of[at(t)]);
    }
  }
  std::vector<Vec3> corners;
  for (const Corner& corner : target_corners_) corners.push_back(target_.frame.to_space(corner.at));
  target_ball_ = ball_round(corners);
  if (!is_known) {
    std::sort(blockers.begin(), blockers.end());
    blockers.erase(std::unique(blockers.begin(), blockers.end()), blockers.end());
  }
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
      solids_.push_back({blocker.body, &body});
    } else
      add(blocker);
  }
  if (shades_.size() + 3 * solids_.size() > most_shades) return;
  is_applicable_ = true;
}

void FewBlockers::add(const Blocker& blocker) {
  const PlaneFrame& frame = target_.frame;
  Shade shade{&blocker, {}, 0, 0, HUGE_VAL, -HUGE_VAL};
  shade.a = {frame.e1.dot(blocker.normal), frame.e2.dot(blocker.normal)};
  shade.b = blocker.normal.dot(frame.origin - blocker.corners.front());
  shade.steepness = shade.a.norm();
  for (const Corner& corner : target_corners_) {
    const double height = shade.a.dot(corner.at) + shade.b;
    shade.least = std::min(shade.least, height);
    shade.most = std::max(shade.most, height);
  }
  shades_.push_back(shade);
}

/// What lies behind a plane through the point. False if nothing of the target does; a plane that
/// all of it lies behind cuts off nothing and is left out.
bool FewBlockers::add_plane(const Vec3& normal, std::uint32_t border) {
  const Vec2 a(target_.frame.e1.dot(normal), target_.frame.e2.dot(normal));
  const double b = -normal.dot(from_frame_), steepness = length_about(a);
  // Parallel to the target.
  if (!(steepness > edge_on * length_about(normal))) return b <= 0;
  const HalfPlane plane{a, b, nearness_ * steepness, border};
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Corner& corner : target_corners_) {
    const double height = a.dot(corner.at) + b;
    least = std::min(least, height);
    most = std::max(most, height);
  }
  if (least > -plane.near) return false;
  if (most >= plane.near) shadow_.push_back(plane);
  return true;
}

/// Adds the sides of its shadow. False if it hides nothing of the target.
bool FewBlockers::make_shadow(const Shade& shade, double height, std::uint32_t border) {
  const double side = height > 0 ? 1 : -1;
  // What is hidden lies beyond the shade's plane.
  const double nearest = side > 0 ? shade.most : -shade.least;
  const double farthest = side > 0 ? shade.least : -shade.most;
  const double near = nearness_ * shade.steepness;
  if (farthest >= -near) return false;
  if (nearest > near) shadow_.push_back({side * shade.a, side * shade.b, near, border});
  const std::vector<Vec3>& corners = shade.blocker->corners;
  Vec3 from = corners.back() - point_;
  for (const Vec3& corner : corners) {
    const Vec3 to = corner - point_;
    if (!add_plane(side * from.cross(to), ++border)) return false;
    from = to;
  }
  return true;
}

/// The same: the cone through the silhouette.
bool FewBlockers::make_shadow(const Silhouette& silhouette, std::uint32_t border) {
  for (const Silhouette::Edge& edge : silhouette.edges)
    if (!add_plane(edge.normal, border + edge.index + 1)) return false;
  return !silhouette.edges.empty();
}

double FewBlockers::sum_over(const Corner* first, const Corner* last) const {
  FlatSum sum(in_frame_, normal_);
  sum.start((last - 1)->at);
  for (; first != last; ++first) sum.add(first->at);
  return sum.form_factor();
}

void FewBlockers::add_hidden(const Part& part, HiddenFactor& factor) const {
  factor.hidden += sum_over(part.data(), part.data() + part.size());
  if (!needs_signature_) return;
  std::uint32_t before = part[part.size() - 2].border, from = part.back().border;
  for (const Corner& to : part) {
    factor.signature +=
        mix_bits(mix_bits((static_cast<std::uint64_t>(before) << 32) + from) + to.border);
    before = from;
    from = to.border;
  }
}

/// Of a convex part: what lies beyond the plane is appended to `corners_` as a part of its own; the
/// rest stays.
void FewBlockers::split(const HalfPlane& plane) {
  const std::size_t count = rest_.size(), start = corners_.size();
  inside_.resize(count + 2);
  corners_.resize(start + count + 2);
  Corner* in = inside_.data();
  Corner* out = corners_.data() + start;
  const Corner* from = &rest_.back();
  double at_from = heights_[count - 1];
  for (std::size_t k = 0; k < count; ++k) {
    const Corner& to = rest_[k];
    const double at_to = heights_[k];
    if (at_from <= 0) *in++ = *from;
    if (at_from >= 0) *out++ = *from;
    // Where the border passes over the line, the line takes it up.
    if ((at_from < 0 && at_to > 0) || (at_from > 0 && at_to < 0)) {
      const Vec2 crossing = from->at + at_from / (at_from - at_to) * (to.at - from->at);
      const bool leaves = at_to > 0;
      *in++ = {crossing, leaves ? plane.border : from->border};
      *out++ = {crossing, leaves ? from->border : plane.border};
    } else if (at_from == 0) {
      if (at_to > 0) in[-1].border = plane.border;
      if (at_to < 0) out[-1].border = plane.border;
    }
    from = &to;
    at_from = at_to;
  }
  inside_.resize(static_cast<std::size_t>(in - inside_.data()));
  const auto end = static_cast<std::size_t>(out - corners_.data());
  if (end > start + 2) {
    corners_.resize(end);
    parts_.push_back({start, end});
  } else
    corners_.resize(start);
  rest_.swap(inside_);
}

/// Heights of a part's corners over a plane.
FewBlockers::Heights FewBlockers::heights_over(const HalfPlane& plane, const Corner* corners,
                                               std::size_t count) {
  Heights range{HUGE_VAL, -HUGE_VAL};
  heights_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    heights_[k] = plane.height(corners[k].at);
    range.least = std::min(range.least, heights_[k]);
    range.most = std::max(range.most, heights_[k]);
  }
  return range;
}

/// Of one part: what lies outside of the shadow is added to the parts, what is left is hidden.
/// False if all lies outside.
bool FewBlockers::cut_off_shadow(const Range& part, HiddenFactor& factor) {
  const std::size_t count = part.last - part.first;
  crossing_.clear();
  // Planes of a shadow all cross the target as a whole.
  const bool is_whole = part.first == 0 && part.last == target_corners_.size();
  for (const HalfPlane& plane : shadow_) {
    if (!is_whole) {
      const Heights range = heights_over(plane, corners_.data() + part.first, count);
      if (range.least >= 0) return false;
      if (range.most <= 0) continue;
    }
    crossing_.push_back(&plane);
  }
  const std::size_t corners_before = corners_.size(), parts_before = parts_.size();
  rest_.assign(corners_.data() + part.first, corners_.data() + part.last);
  for (const HalfPlane* plane : crossing_) {
    const Heights range = heights_over(*plane, rest_.data(), rest_.size());
    if (range.most <= 0) continue;
    if (range.least >= 0) {
      corners_.resize(corners_before);
      parts_.resize(parts_before);
      return false;
    }
    split(*plane);
  }
  if (rest_.size() > 2) add_hidden(rest_, factor);
  return true;
}

void FewBlockers::cut_off_shadow(HiddenFactor& factor) {
  const std::size_t count = parts_.size();
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Range part = parts_[k];
    if (!cut_off_shadow(part, factor)) parts_[kept++] = part;
  }
  parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(kept),
               parts_.begin() + static_cast<std::ptrdiff_t>(count));
}

double FewBlockers::sum_over_parts() const {
  double sum = 0;
  for (const auto& [first, last] : parts_)
    sum += sum_over(corners_.data() + first, corners_.data() + last);
  return sum;
}

void FewBlockers::stand_at(const Vec3& point) {
  point_ = point;
  from_frame_ = point - target_.frame.origin;
  in_frame_ = turned(target_.frame, from_frame_);
}

void FewBlockers::look_from(const Vec3& point) {
  stand_at(point);
  towards_ = target_ball_.centre - point;
  const double distance = towards_.norm();
  const double sine = target_ball_.radius / distance;
  tangent_ = HUGE_VAL;
  if (!(sine < nearly_all_round)) return;
  secant_ = 1 / std::sqrt(1 - sine * sine);
  tangent_ = sine * secant_;
  towards_ /= distance;
}

/// Whether a ball lies outside of the cone from the point to the target's ball.
bool FewBlockers::is_beside(const Ball& ball) const {
  if (tangent_ == HUGE_VAL) return false;
  const Vec3 to = ball.centre - point_;
  const double along = towards_.dot(to);
  const double reach = along * tangent_ + ball.radius * secant_ * slightly_more;
  return reach < 0 || to.squaredNorm() - along * along > reach * reach;
}

/// Leaves the parts that are seen. False if there are too many.
template <class SilhouetteOf>
bool FewBlockers::cut_off_all(SilhouetteOf silhouette_of, HiddenFactor& factor) {
  const auto can_go_on = [&] { return !parts_.empty() && parts_.size() <= most_parts; };
  std::uint32_t border = 0;
  for (std::size_t k = 0; k < solids_.size() && can_go_on(); ++k) {
    const Solid& solid = solids_[k];
    border += borders_of_shade;
    if (is_beside(solid.shape->ball)) continue;
    shadow_.clear();
    if (make_shadow(silhouette_of(solid), border)) cut_off_shadow(factor);
  }
  // Fronts first: what backs of closed things hide is hidden then.
  for (const double side : {1., -1.})
    for (std::size_t k = 0; k < shades_.size() && can_go_on(); ++k) {
      const Shade& shade = shades_[k];
      const Vec3 towards = point_ - shade.blocker->corners.front();
      const double height = shade.blocker->normal.dot(towards);
      if (!(height * side > edge_on * length_about(towards)) || is_beside(shade.blocker->ball))
        continue;
      const auto number = static_cast<std::uint32_t>(solids_.size() + k + 1);
      shadow_.clear();
      if (make_shadow(shade, height, number * borders_of_shade)) cut_off_shadow(factor);
    }
  factor.is_dark = parts_.empty();
  return parts_.size() <= most_parts;
}

bool FewBlockers::factor(const Vec3& point, HiddenFactor& factor) {
  factor = {};
  if (!(target_.frame.height(point) > 0) || target_parts_.empty()) return true;
  look_from(point);
  take_all();
  factor.unobstructed = sum_over_parts();
  if (!(factor.unobstructed > 0)) {
    factor.unobstructed = 0;
    return true;
  }
  const auto silhouette_of = [&](const Solid& solid) -> const Silhouette& {
    find_silhouette(*solid.shape, point, silhouette_);
    return silhouette_;
  };
  needs_signature_ = true;
  if (!cut_off_all(silhouette_of, factor)) return false;
  if (factor.is_dark) {
    factor.signature = dark_signature;
    factor.hidden = factor.unobstructed;
    return true;
  }
  if (factor.signature == 0) factor.signature = lit_signature;
  factor.hidden = std::clamp(factor.hidden, 0., factor.unobstructed);
  return true;
}

bool FewBlockers::hidden_factor(Silhouettes& silhouettes, HiddenFactor& factor) {
  factor = {};
  if (!(target_.frame.height(silhouettes.point()) > 0) || target_parts_.empty()) return true;
  look_from(silhouettes.point());
  take_all();
  needs_signature_ = false;
  if (!cut_off_all(
          [&](const Solid& solid) -> const Silhouette& { return silhouettes.of(solid.body); },
          factor))
    return false;
  factor.hidden = std::max(factor.hidden, 0.);
  return true;
}

double FewBlockers::seen_at_most(const std::array<Vec3, 3>& cell) {
  take_all();
  HiddenFactor unused;
  // What lies in the shadows from all three corners.
  const auto cut_off_common = [&](auto make) {
    if (parts_.empty() || parts_.size() > most_parts) return;
    shadow_.clear();
    for (const Vec3& corner : cell) {
      stand_at(corner);
      if (!make()) return;
    }
    cut_off_shadow(unused);
  };
  for (const Solid& solid : solids_)
    cut_off_common([&] {
      find_silhouette(*solid.shape, point_, silhouette_);
      return make_shadow(silhouette_, 0);
    });
  for (const Shade& shade : shades_) {
    double side = 0;  // the same for all corners, or nothing is sure
    cut_off_common([&] {
      const Vec3 towards = point_ - shade.blocker->corners.front();
      const double height = shade.blocker->normal.dot(towards);
      if (side == 0) side = height;
      return height * side > 0 && std::abs(height) > edge_on * length_about(towards) &&
             make_shadow(shade, height, 0);
    });
  }
  double most = 0;
  for (const Vec3& corner : cell) {
    stand_at(corner);
    most = std::max(most, sum_over_parts());
  }
  return most;
}

}  // namespace halfshade
