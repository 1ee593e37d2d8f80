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

template <class Ball>
Ball ball_round(const std::vector<Vec3>& points) {
  Ball ball{Vec3::Zero(), 0};
  for (const Vec3& p : points) ball.centre += p / static_cast<double>(points.size());
  for (const Vec3& p : points) ball.radius = std::max(ball.radius, (p - ball.centre).norm());
  return ball;
}

}  // namespace

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
    const std::size_t first = target_corners_.size();
    for (const Vec3& p : other) {
      const std::size_t number = target_corners_.size() - first;
      target_corners_.push_back({target_.frame.to_plane(p), static_cast<std::uint32_t>(number)});
      size = std::max(size, (p - other.front()).norm());
    }
    target_parts_.push_back({first, target_corners_.size()});
    for (const Polygon3& own_piece : own.pieces) {
      const Polygon3 part = clip_to_front(own_piece, target_.frame.origin, target_.frame.normal);
      if (part.empty()) continue;
      for (const int t : triangles_between(scene, part, a, other, b))
        blockers.push_back(scene.blocker_of[at(t)]);
    }
  }
  std::vector<Vec3> corners;
  for (const Corner& corner : target_corners_)
    corners.emplace_back(corner.at.x(), corner.at.y(), 0);
  target_ball_ = ball_round<Ball>(corners);
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
  shade.ball = ball_round<Ball>(shade.corners);
  shade.normal = turned(blocker.normal);
  shade.a = shade.normal.head<2>();
  shade.b = -shade.normal.dot(shade.corners.front());
  shade.steepness = shade.a.norm();
  shade.least = HUGE_VAL;
  shade.most = -HUGE_VAL;
  for (const Corner& corner : target_corners_) {
    const double height = shade.a.dot(corner.at) + shade.b;
    shade.least = std::min(shade.least, height);
    shade.most = std::max(shade.most, height);
  }
  shades_.push_back(std::move(shade));
}

void FewBlockers::add(const ConvexBody& body) {
  Solid solid{{}, &body, {}, {}, {}};
  for (const Vec3& p : body.vertices) solid.vertices.push_back(in_frame(p));
  solid.ball = ball_round<Ball>(solid.vertices);
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

/// Adds the sides of its shadow. False if it hides nothing of the target.
bool FewBlockers::make_shadow(const Shade& shade, double height, std::uint32_t border) {
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

/// The same: the cone through the edges between sides that the point sees and those that it does
/// not.
bool FewBlockers::make_shadow(const Solid& solid, std::uint32_t border) {
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

/// Of one part: what lies outside of the shadow is added to the parts, what is left is hidden.
/// False if all lies outside.
bool FewBlockers::cut_off_shadow(const Range& part, HiddenFactor& factor) {
  const auto is_off = [&](const HalfPlane& plane) {
    for (std::size_t k = part.first; k < part.last; ++k)
      if (plane.height(corners_[k].at) < 0) return false;
    return true;
  };
  if (std::any_of(shadow_.begin(), shadow_.end(), is_off)) return false;
  const std::size_t corners_before = corners_.size(), parts_before = parts_.size();
  rest_.assign(corners_.data() + part.first, corners_.data() + part.last);
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
      corners_.resize(corners_before);
      parts_.resize(parts_before);
      return false;
    }
    inside_.clear();
    const std::size_t start = corners_.size();
    const Corner* from = &rest_.back();
    double at_from = heights_.back();
    for (std::size_t k = 0; k < rest_.size(); ++k) {
      const Corner& to = rest_[k];
      const double at_to = heights_[k];
      if (at_from <= 0) inside_.push_back(*from);
      if (at_from >= 0) corners_.push_back(*from);
      // Where the border passes over the line, the line takes it up.
      if (at_from < 0 && at_to > 0) {
        const Vec2 crossing = from->at + at_from / (at_from - at_to) * (to.at - from->at);
        inside_.push_back({crossing, plane.border});
        corners_.push_back({crossing, from->border});
      } else if (at_from > 0 && at_to < 0) {
        const Vec2 crossing = from->at + at_from / (at_from - at_to) * (to.at - from->at);
        corners_.push_back({crossing, plane.border});
        inside_.push_back({crossing, from->border});
      } else if (at_from == 0) {
        if (at_to > 0) inside_.back().border = plane.border;
        if (at_to < 0) corners_.back().border = plane.border;
      }
      from = &to;
      at_from = at_to;
    }
    if (corners_.size() > start + 2)
      parts_.push_back({start, corners_.size()});
    else
      corners_.resize(start);
    rest_.swap(inside_);
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

void FewBlockers::take_all() {
  corners_ = target_corners_;
  parts_ = target_parts_;
}

double FewBlockers::sum_over_parts() const {
  double sum = 0;
  for (const auto& [first, last] : parts_)
    sum += sum_over(corners_.data() + first, corners_.data() + last);
  return sum;
}

void FewBlockers::look_from(const Vec3& point) {
  point_ = in_frame(point);
  towards_ = target_ball_.centre - point_;
  const double distance = towards_.norm();
  const double sine = target_ball_.radius / distance;
  tangent_ = HUGE_VAL;
  if (!(sine < nearly_all_round)) return;
  secant_ = 1 / std::sqrt(1 - sine * sine);
  tangent_ = sine * secant_;
  towards_ /= distance;
}

/// Whether it lies outside of the cone from the point to the target's ball.
bool FewBlockers::is_beside(const Ball& ball) const {
  if (tangent_ == HUGE_VAL) return false;
  const Vec3 to = ball.centre - point_;
  const double along = towards_.dot(to);
  const double reach = along * tangent_ + ball.radius * secant_ * slightly_more;
  return reach < 0 || to.squaredNorm() - along * along > reach * reach;
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
  const auto can_go_on = [&] { return !parts_.empty() && parts_.size() <= most_parts; };
  std::uint32_t border = 0;
  for (std::size_t k = 0; k < solids_.size() && can_go_on(); ++k) {
    border += borders_of_shade;
    if (is_beside(solids_[k].ball)) continue;
    shadow_.clear();
    if (make_shadow(solids_[k], border)) cut_off_shadow(factor);
  }
  // Fronts first: what backs of closed things hide is hidden then.
  for (const double side : {1., -1.})
    for (std::size_t k = 0; k < shades_.size() && can_go_on(); ++k) {
      const Shade& shade = shades_[k];
      const Vec3 towards = point_ - shade.corners.front();
      const double height = shade.normal.dot(towards);
      if (!(height * side > edge_on * length_about(towards)) || is_beside(shade.ball)) continue;
      const auto number = static_cast<std::uint32_t>(solids_.size() + k + 1);
      shadow_.clear();
      if (make_shadow(shade, height, number * borders_of_shade)) cut_off_shadow(factor);
    }
  if (parts_.size() > most_parts) return false;
  factor.is_dark = parts_.empty();
  if (factor.is_dark) {
    factor.signature = dark_signature;
    factor.hidden = factor.unobstructed;
    return true;
  }
  if (factor.signature == 0) factor.signature = lit_signature;
  factor.hidden = std::clamp(factor.hidden, 0., factor.unobstructed);
  return true;
}

double FewBlockers::seen_at_most(const std::array<Vec3, 3>& cell) {
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = in_frame(cell[k]);
  take_all();
  HiddenFactor unused;
  // What lies in the shadows from all three corners.
  const auto cut_off_common = [&](auto make) {
    if (parts_.empty() || parts_.size() > most_parts) return;
    shadow_.clear();
    for (const Vec3& corner : corners) {
      point_ = corner;
      if (!make()) return;
    }
    cut_off_shadow(unused);
  };
  for (const Solid& solid : solids_) cut_off_common([&] { return make_shadow(solid, 0); });
  for (const Shade& shade : shades_) {
    double side = 0;  // the same for all corners, or nothing is sure
    cut_off_common([&] {
      const Vec3 towards = point_ - shade.corners.front();
      const double height = shade.normal.dot(towards);
      if (side == 0) side = height;
      return height * side > 0 && std::abs(height) > edge_on * length_about(towards) &&
             make_shadow(shade, height, 0);
    });
  }
  double most = 0;
  for (const Vec3& corner : corners) {
    point_ = corner;
    most = std::max(most, sum_over_parts());
  }
  return most;
}

}  // namespace halfshade
