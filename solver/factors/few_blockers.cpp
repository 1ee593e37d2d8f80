#include "solver/factors/few_blockers.h"

#include "meshing/geometry/mix_bits.h"
#include "solver/factors/points_across.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr std::size_t most_shades = 400;
constexpr std::size_t most_parts = 1024;
/// Parts for which it pays to know where a shadow lies before it is cut off.
constexpr std::size_t worth_a_reach = 8;
/// What is nearer to a line lies on it: relative to the target.
constexpr double nearness_of_target = 1e-11;
/// A point this near to a blocker's plane sees its edge: relative to the blocker.
constexpr double edge_on = 1e-12;
constexpr std::uint64_t lit_signature = 0x2fd08b6e51c3a497, dark_signature = 0x81e6c35a0f94d72b;
/// Of the two surfaces, multiplied: each pair of them is searched for what comes between.
constexpr std::size_t most_pieces = 16;
/// Borders of one shade are numbered from a multiple of this on.
constexpr std::uint32_t borders_of_shade = 1 << 20;

/// At most √2 times the length, and a good deal quicker.
double length_about(const Vec2& a) { return std::abs(a.x()) + std::abs(a.y()); }
double length_about(const Vec3& a) { return std::abs(a.x()) + std::abs(a.y()) + std::abs(a.z()); }

Vec3 turned(const PlaneFrame& frame, const Vec3& direction) {
  return {frame.e1.dot(direction), frame.e2.dot(direction), frame.normal.dot(direction)};
}

}  // namespace

FewBlockers::FewBlockers(const SightScene& scene, int a, int b, std::vector<int> blockers)
    : own_(scene.surfaces[at(a)]), target_(scene.surfaces[at(b)]), target_id_(b) {
  if (own_.pieces.size() * target_.pieces.size() > most_pieces) return;
  normal_ = turned(target_.frame, own_.frame.normal);
  if (blockers.empty()) blockers = blockers_between(scene, a, b);
  double size = 0;
  for (const Polygon3& piece : target_.pieces) {
    const Polygon3 other = clip_to_front(piece, own_.frame.origin, own_.frame.normal);
    if (other.empty()) continue;
    Ring flat;
    for (const Vec3& p : other) {
      flat.push_back(target_.frame.to_plane(p));
      size = std::max(size, (p - other.front()).norm());
    }
    parts_.add(flat);
  }
  for (const Corner& corner : parts_.corners_of_all())
    target_in_space_.push_back(target_.frame.to_space(corner.at));
  target_ball_ = ball_round(target_in_space_);
  nearness_ = nearness_of_target * size;
  // Where a body lies before the target's plane as a whole, all that it covers is hidden.
  const auto is_before = [&](const Vec3& p) { return target_.frame.height(p) >= -nearness_; };
  for (const int b : blockers) {
    const Blocker& blocker = scene.blockers[at(b)];
    if (blocker.corners.size() + 1 >= borders_of_shade) return;
    if (blocker.body < 0) {
      add(blocker);
      continue;
    }
    const auto known = std::find_if(solids_.begin(), solids_.end(),
                                    [&](const Solid& solid) { return solid.body == blocker.body; });
    if (known != solids_.end()) {
      known->sides.push_back(&blocker);
      continue;
    }
    const ConvexBody& body = scene.bodies[at(blocker.body)];
    if (body.edges.size() < borders_of_shade &&
        std::all_of(body.vertices.begin(), body.vertices.end(), is_before) &&
        !is_within_sight(body, {own_.pieces, own_.frame.normal},
                         {target_.pieces, target_.frame.normal}))
      solids_.push_back({blocker.body, &body, {&blocker}});
    else
      add(blocker);
  }
  forget_found();
  if (shades_.size() + 3 * solids_.size() > most_shades) return;
  is_applicable_ = true;
}

void FewBlockers::add(const Blocker& blocker) {
  const PlaneFrame& frame = target_.frame;
  Shade shade{&blocker, {}, 0, 0, HUGE_VAL, -HUGE_VAL};
  shade.a = {frame.e1.dot(blocker.normal), frame.e2.dot(blocker.normal)};
  shade.b = blocker.normal.dot(frame.origin - blocker.corners.front());
  shade.steepness = shade.a.norm();
  for (const Corner& corner : parts_.corners_of_all()) {
    const double height = shade.a.dot(corner.at) + shade.b;
    shade.least = std::min(shade.least, height);
    shade.most = std::max(shade.most, height);
  }
  shades_.push_back(shade);
}

double FewBlockers::Shade::height(const Vec3& point) const {
  const Vec3 towards = point - blocker->corners.front();
  const double height = blocker->normal.dot(towards);
  return std::abs(height) > edge_on * length_about(towards) ? height : 0;
}

std::span<const Blocker* const> FewBlockers::sides(std::size_t thing) const {
  if (thing < solids_.size()) return solids_[thing].sides;
  return {&shades_[thing - solids_.size()].blocker, 1};
}

double FewBlockers::found(std::size_t thing) const {
  return looks_ == 0 ? 0 : found_[thing] / static_cast<double>(looks_);
}

void FewBlockers::forget_found() {
  found_.assign(things(), 0);
  looks_ = 0;
}

double FewBlockers::points_across(std::span<const Quad> quads) const {
  PointsAcross across(own_.frame, quads, target_ball_);
  for (const Solid& solid : solids_) across.add(*solid.shape);
  for (const Shade& shade : shades_) across.add(*shade.blocker);
  return across.points();
}

double FewBlockers::hidden_by(std::size_t thing, const Vec3& point) {
  if (!(target_.frame.height(point) > 0) || parts_.is_nothing()) return 0;
  stand_at(point);
  parts_.take_all();
  shadow_.clear();
  if (thing < solids_.size()) {
    if (!make_shadow(*solids_[thing].shape, 0)) return 0;
  } else {
    const Shade& shade = shades_[thing - solids_.size()];
    const double height = shade.height(point);
    if (height == 0 || !make_shadow(shade, height, 0)) return 0;
  }
  double sum = 0;
  parts_.cut_off(shadow_, FlatParts::everywhere(),
                 [&](std::span<const Corner> part) { sum += sum_over(part); });
  return sum;
}

/// What lies behind a plane through the point and a corner, which is nearer to the target and loses
/// less to rounding. False if nothing of the target does; a plane that
/// all of it lies behind cuts off nothing and is left out.
bool FewBlockers::add_plane(const Vec3& normal, const Vec3& corner, std::uint32_t border) {
  const Vec2 a(target_.frame.e1.dot(normal), target_.frame.e2.dot(normal));
  const double b = normal.dot(target_.frame.origin - corner), steepness = length_about(a);
  // Parallel to the target.
  if (!(steepness > edge_on * length_about(normal))) return b <= 0;
  const FlatParts::HalfPlane plane{a, b, nearness_ * steepness, border};
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Corner& corner : parts_.corners_of_all()) {
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
  const Vec3* from = &corners.back();
  for (const Vec3& to : corners) {
    if (!add_plane(side * (*from - point_).cross(to - *from), to, ++border)) return false;
    from = &to;
  }
  return true;
}

/// The same of a body: the cone through its silhouette. From an open side, on which only what looks
/// in lies, it hides all.
bool FewBlockers::make_shadow(const ConvexBody& body, std::uint32_t border) {
  find_silhouette(body, point_, silhouette_);
  for (const Silhouette::Edge& edge : silhouette_.edges)
    if (!add_plane(edge.normal, edge.corner, border + edge.index + 1)) return false;
  return !silhouette_.edges.empty() || body.open_sides > 0;
}

double FewBlockers::sum_over(std::span<const Corner> part) const {
  FlatSum sum(in_frame_, normal_);
  sum.start(part.back().at);
  for (const Corner& corner : part) sum.add(corner.at);
  return sum.form_factor();
}

void FewBlockers::add_hidden(std::span<const Corner> part, HiddenFactor& factor) const {
  factor.hidden += sum_over(part);
  std::uint32_t before = part[part.size() - 2].border, from = part.back().border;
  for (const Corner& to : part) {
    factor.signature +=
        mix_bits(mix_bits((static_cast<std::uint64_t>(before) << 32) + from) + to.border);
    before = from;
    from = to.border;
  }
}

/// Where the shadow of a convex polygon or body lies: everywhere, if that tells little or takes too
/// long. Of polygons what is not nearer to the target than the point casts none; corners of bodies
/// are in no order.
FlatParts::Box FewBlockers::reach_of_shadow(std::span<const Vec3> corners, bool is_polygon) const {
  if (parts_.count() < worth_a_reach) return FlatParts::everywhere();
  FlatParts::Box reach;
  const auto is_ahead = [&](const Vec3& to) { return to.z() < -nearness_; };
  const auto extend = [&](const Vec3& to, double height) {
    reach.extend(in_frame_.head<2>() - in_frame_.z() / height * to.head<2>());
  };
  Vec3 from = turned(target_.frame, corners.back() - point_);
  for (const Vec3& corner : corners) {
    const Vec3 to = turned(target_.frame, corner - point_);
    if (!is_polygon && !is_ahead(to)) return FlatParts::everywhere();
    if (is_polygon && is_ahead(from) != is_ahead(to)) {
      const double part = (from.z() + nearness_) / (from.z() - to.z());
      extend(from + part * (to - from), -nearness_);
    }
    if (is_ahead(to)) extend(to, to.z());
    from = to;
  }
  if (reach.isEmpty()) return FlatParts::everywhere();
  return {reach.min().array() - nearness_, reach.max().array() + nearness_};
}

double FewBlockers::sum_over_parts() const {
  double sum = 0;
  for (std::size_t k = 0; k < parts_.count(); ++k) sum += sum_over(parts_.part(k));
  return sum;
}

void FewBlockers::stand_at(const Vec3& point) {
  point_ = point;
  from_frame_ = point - target_.frame.origin;
  in_frame_ = turned(target_.frame, from_frame_);
}

void FewBlockers::look_from(const Vec3& point) {
  stand_at(point);
  view_ = ViewCone(point, target_ball_);
}

/// Leaves the parts that are seen. False if there are too many.
bool FewBlockers::cut_off_all(HiddenFactor& factor) {
  const auto can_go_on = [&] { return parts_.count() > 0 && parts_.count() <= most_parts; };
  const auto cut_off = [&](std::size_t thing, std::span<const Vec3> corners) {
    const double before = factor.hidden;
    parts_.cut_off(shadow_, reach_of_shadow(corners, thing >= solids_.size()),
                   [&](std::span<const Corner> part) { add_hidden(part, factor); });
    found_[thing] += factor.hidden - before;
  };
  std::uint32_t border = 0;
  for (std::size_t k = 0; k < solids_.size() && can_go_on(); ++k) {
    const Solid& solid = solids_[k];
    border += borders_of_shade;
    if (view_.is_beside(solid.shape->ball)) continue;
    shadow_.clear();
    if (make_shadow(*solid.shape, border)) cut_off(k, solid.shape->vertices);
  }
  // Fronts first: what backs of closed things hide is hidden then.
  for (const double side : {1., -1.})
    for (std::size_t k = 0; k < shades_.size() && can_go_on(); ++k) {
      const Shade& shade = shades_[k];
      const double height = shade.height(point_);
      if (!(height * side > 0) || view_.is_beside(shade.blocker->ball)) continue;
      const auto number = static_cast<std::uint32_t>(solids_.size() + k + 1);
      shadow_.clear();
      if (make_shadow(shade, height, number * borders_of_shade))
        cut_off(solids_.size() + k, shade.blocker->corners);
    }
  factor.is_dark = parts_.count() == 0;
  return parts_.count() <= most_parts;
}

bool FewBlockers::factor(const Vec3& point, HiddenFactor& factor) {
  factor = {};
  ++looks_;
  if (!(target_.frame.height(point) > 0) || parts_.is_nothing()) return true;
  look_from(point);
  parts_.take_all();
  factor.unobstructed = sum_over_parts();
  if (!(factor.unobstructed > 0)) {
    factor.unobstructed = 0;
    return true;
  }
  if (!cut_off_all(factor)) return false;
  if (factor.is_dark) {
    factor.signature = dark_signature;
    factor.hidden = factor.unobstructed;
    return true;
  }
  if (factor.signature == 0) factor.signature = lit_signature;
  factor.hidden = std::clamp(factor.hidden, 0., factor.unobstructed);
  return true;
}

ShadedTarget FewBlockers::shaded_target(SharedShadows& shadows, TargetMemory& memory) const {
  ShadedTarget target(shadows.on_plane_of(target_id_), memory, normal_, nearness_);
  if (!is_applicable_) return target;
  for (std::size_t k = 0; k < parts_.count_of_all(); ++k) target.add_part(parts_.part_of_all(k));
  for (const Solid& solid : solids_) target.add_body(solid.body);
  for (const Shade& shade : shades_) target.add_polygon(*shade.blocker);
  return target;
}

double FewBlockers::seen_at_most(const std::array<Vec3, 3>& cell) {
  parts_.take_all();
  // What lies in the shadows from all three corners.
  const auto cut_off_common = [&](auto make) {
    if (parts_.count() == 0 || parts_.count() > most_parts) return;
    shadow_.clear();
    for (const Vec3& corner : cell) {
      stand_at(corner);
      if (!make()) return;
    }
    parts_.cut_off(shadow_, FlatParts::everywhere(), [](std::span<const Corner>) {});
  };
  for (const Solid& solid : solids_) cut_off_common([&] { return make_shadow(*solid.shape, 0); });
  for (const Shade& shade : shades_) {
    double side = 0;  // the same for all corners, or nothing is sure
    cut_off_common([&] {
      const double height = shade.height(point_);
      if (side == 0) side = height;
      return height * side > 0 && make_shadow(shade, height, 0);
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
