#include "solver/factors/body_target.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace halfshade {
namespace {

/// What is nearer to a line of the view lies on it: relative to the outline.
constexpr double nearness_of_view = 1e-12;
/// From nearer to all its sides, relative to its size, a body is not looked at.
constexpr double too_near = 1e-7;
/// Points this near to a polygon's plane, relative to their distance, see it edge-on.
constexpr double edge_on_polygon = 1e-12;
constexpr std::size_t most_parts_of_body = 1024;

bool is_before(const ConvexBody::Side& plane, std::span<const Vec3> points, double near) {
  return std::all_of(points.begin(), points.end(),
                     [&](const Vec3& p) { return plane.normal.dot(p - plane.corner) >= -near; });
}

ConvexBody::Side turned_round(const ConvexBody::Side& plane) {
  return {plane.corner, -plane.normal};
}

/// A side of a body that has all points before it.
std::optional<ConvexBody::Side> side_before(const ConvexBody& body, std::span<const Vec3> points,
                                            double near) {
  for (const ConvexBody::Side& side : body.sides)
    if (is_before(side, points, near)) return side;
  return {};
}

/// Whether no point of a surface lies within a body, but on it at most.
bool lies_beside(const ConvexBody& body, const SightSurface& surface) {
  const double near = rounding_of(body);
  const ConvexBody::Side plane{surface.frame.origin, surface.frame.normal};
  return side_before(body, surface.outline, near) || is_before(plane, body.vertices, near) ||
         is_before(turned_round(plane), body.vertices, near) ||
         !reaches_into(body, {surface.pieces, surface.frame.normal});
}

}  // namespace

BodyTarget::BodyTarget(const SightScene& scene, int surface, int body, std::span<const int> sides)
    : scene_(scene),
      own_(scene.surfaces[at(surface)]),
      body_(body),
      shape_(scene.bodies[at(body)]) {
  next_.assign(shape_.vertices.size(), -1);
  if (!lies_beside(shape_, own_)) return;
  // Through an open side its inside would be seen.
  for (std::size_t k = shape_.sides.size() - shape_.open_sides; k < shape_.sides.size(); ++k)
    if (!is_before(turned_round(shape_.sides[k]), own_.outline, rounding_of(shape_))) return;
  std::set<int> blockers, bodies;
  for (const int side : sides)
    for (const int b : blockers_between(scene, surface, side)) blockers.insert(b);
  for (const int b : blockers) {
    const Blocker& blocker = scene.blockers[at(b)];
    if (blocker.body >= 0)
      bodies.insert(blocker.body);
    else if (!add(blocker))
      return;
  }
  bodies.erase(body);  // of a convex body no side hides what is seen of others
  is_applicable_ = std::all_of(bodies.begin(), bodies.end(), [&](int b) { return add(b); });
}

/// False if it may hide anything else than what a solid does, or no plane lies between.
bool BodyTarget::add(int body) {
  const ConvexBody& other = scene_.bodies[at(body)];
  const double near = std::max(rounding_of(shape_), rounding_of(other));
  std::optional<ConvexBody::Side> plane = side_before(shape_, other.vertices, near);
  if (!plane) {
    plane = side_before(other, shape_.vertices, near);
    if (!plane) return false;
    plane = turned_round(*plane);
  }
  const std::vector<Polygon3> nothing;  // of what is seen lies in it
  if (other.open_sides > 0 &&
      (!lies_outside(other, shape_.vertices) ||
       is_within_sight(other, {own_.pieces, own_.frame.normal}, {nothing, own_.frame.normal})))
    return false;
  things_.push_back({body, nullptr, *plane});
  return true;
}

bool BodyTarget::add(const Blocker& polygon) {
  const double near = std::max(rounding_of(shape_), polygon.rounding);
  std::optional<ConvexBody::Side> plane = side_before(shape_, polygon.corners, near);
  for (const double sign : {1., -1.}) {
    const ConvexBody::Side own{polygon.corners.front(), sign * polygon.normal};
    if (!plane && is_before(turned_round(own), shape_.vertices, near)) plane = own;
  }
  if (!plane) return false;
  things_.push_back({-1, &polygon, *plane});
  return true;
}

double BodyTarget::points_across(std::span<const Quad> quads) const {
  PointsAcross across(own_.frame, quads, shape_.ball);
  for (const Thing& thing : things_)
    thing.polygon ? across.add(*thing.polygon) : across.add(scene_.bodies[at(thing.body)]);
  return across.points();
}

/// Parallel to the side whose plane is farthest from the point, behind which all of the body lies:
/// so its outline has an end in every direction.
bool BodyTarget::find_view(const Vec3& point) {
  double farthest = 0;
  const ConvexBody::Side* side = nullptr;
  for (const ConvexBody::Side& s : shape_.sides) {
    const double height = s.normal.dot(point - s.corner);
    if (height > farthest) {
      farthest = height;
      side = &s;
    }
  }
  if (!(farthest > too_near * shape_.ball.radius)) return false;
  view_ = make_frame(point, side->normal);
  return true;
}

/// False if the edges are no loop: rounding.
bool BodyTarget::find_outline(const Outlines::Edges& edges, const Vec3& point) {
  for (const auto& [from, to] : edges) next_[at(from)] = to;
  x_.clear();
  y_.clear();
  box_ = {};
  int v = edges.front()[0];
  do {
    const Vec3 towards = shape_.vertices[at(v)] - point;
    const double scale = -1 / view_.normal.dot(towards);
    x_.push_back(scale * view_.e1.dot(towards));
    y_.push_back(scale * view_.e2.dot(towards));
    box_.add(x_.back(), y_.back());
    v = std::exchange(next_[at(v)], -1);
  } while (v >= 0 && v != edges.front()[0]);
  const bool is_loop = v >= 0 && x_.size() == edges.size();
  for (const auto& [from, to] : edges) next_[at(from)] = -1;
  nearness_ = nearness_of_view * std::max({-box_.left, box_.right, -box_.low, box_.high});
  return is_loop;
}

/// The plane through the point and an edge; what it hides lies to the left.
void BodyTarget::add_side(const Vec3& from, const Vec3& to, const Vec3& point) {
  const Vec3 out = (from - point).cross(to - from);
  cone_.push_back({view_.e1.dot(out), view_.e2.dot(out), -view_.normal.dot(out)});
}

/// Whether a body that a point of the surface is in, or on, hides all: unless the surface lies on
/// it and looks away.
bool BodyTarget::hides_from_inside(const ConvexBody& body) const {
  return std::any_of(body.vertices.begin(), body.vertices.end(),
                     [&](const Vec3& p) { return own_.frame.height(p) > rounding_of(body); });
}

/// False if the point sees it behind the body, or edge-on.
bool BodyTarget::find_cone(const Thing& thing, Outlines& outlines) {
  const Vec3& point = outlines.point();
  cone_.clear();
  if (!(thing.plane.normal.dot(point - thing.plane.corner) > 0)) return false;
  const Ball& ball = thing.polygon ? thing.polygon->ball : scene_.bodies[at(thing.body)].ball;
  if (cone_of_body_.is_beside(ball)) return false;
  if (!thing.polygon) {
    const std::vector<Vec3>& vertices = scene_.bodies[at(thing.body)].vertices;
    for (const auto& [from, to] : outlines.of(thing.body))
      add_side(vertices[at(from)], vertices[at(to)], point);
    return !cone_.empty() || hides_from_inside(scene_.bodies[at(thing.body)]);
  }
  const std::vector<Vec3>& corners = thing.polygon->corners;
  const Vec3 towards = point - corners.front();
  const double height = thing.polygon->normal.dot(towards);
  if (!(std::abs(height) > edge_on_polygon * towards.lpNorm<1>())) return false;
  for (std::size_t from = corners.size() - 1, to = 0; to < corners.size(); from = to++)
    height > 0 ? add_side(corners[from], corners[to], point)
               : add_side(corners[to], corners[from], point);
  return true;
}

/// What of the outline lies above the horizon becomes what is cut. False if it cannot be told.
bool BodyTarget::stand_at(Outlines& outlines) {
  cut_.clear();
  edges_.clear();
  const Outlines::Edges& edges = outlines.of(body_);
  if (edges.empty()) return true;  // on an open side, or on a side
  cone_of_body_ = ViewCone(outlines.point(), shape_.ball);
  if (!find_view(outlines.point()) || !find_outline(edges, outlines.point())) return false;
  const Vec3& own = own_.frame.normal;
  normal_ = {own.dot(view_.e1), own.dot(view_.e2), own.dot(view_.normal)};
  const ShadowSide above{-normal_.x(), -normal_.y(), normal_.z()};
  const auto seen = horizon_.common({x_.data(), y_.data(), x_.size()}, {&above, 1}, nearness_);
  if (seen.count > 2) cut_.add(seen);
  return true;
}

void BodyTarget::cut_off_cone() {
  crossing_.clear();
  if (!add_crossing(cone_, box_, nearness_, crossing_)) return;
  cut_.cut_off(crossing_, FlatBox::everywhere(), nearness_, true,
               [&](const ShadowCut::Corners& part) { edges_.add(part.x, part.y, part.count); });
}

double BodyTarget::sum_of_edges() { return std::max(0., edges_.form_factor({0, 0, 1}, normal_)); }

bool BodyTarget::hidden_factor(Outlines& outlines, HiddenFactor& factor) {
  factor = {};
  if (!stand_at(outlines)) return false;
  for (const Thing& thing : things_) {
    if (cut_.count() == 0) break;
    if (find_cone(thing, outlines)) cut_off_cone();
    if (cut_.count() > most_parts_of_body) return false;
  }
  factor.is_dark = cut_.count() == 0;
  factor.hidden = sum_of_edges();
  return true;
}

double BodyTarget::seen_at_most(std::span<const Vec3> corners, Outlines& outlines) {
  double whole = 0;
  std::vector<double> past(things_.size(), 0);  // each thing alone, summed over corners
  for (const Vec3& corner : corners) {
    outlines.move_to(corner);
    if (!stand_at(outlines)) return 1;
    if (cut_.count() == 0) continue;
    cone_.clear();
    cut_off_cone();  // all
    const double all = sum_of_edges();
    whole = std::max(whole, all);
    for (std::size_t k = 0; k < things_.size(); ++k) {
      past[k] += all;
      if (!find_cone(things_[k], outlines)) continue;
      stand_at(outlines);
      cut_off_cone();
      past[k] -= cut_.count() == 0 ? all : std::min(all, sum_of_edges());
    }
  }
  for (const double seen : past) whole = std::min(whole, seen);
  return whole;
}

}  // namespace halfshade
