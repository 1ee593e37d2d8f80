#include "meshing/events/swath.h"

#include "meshing/events/margins.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

using Interval = std::array<double, 2>;

/// Normal of the plane through a point and an edge.
Vec3 plane_through(const Vec3& point, const Span3& edge) {
  return (edge.from - point).cross(edge.direction());
}

/// Real roots in (0,1).
void add_roots(const Quadratic& polynomial, std::vector<double>& parameters) {
  const QuadraticRoots found = roots(polynomial);
  for (int k = 0; k < found.count; ++k)
    if (const double t = found.at[at(k)]; t > 0 && t < 1) parameters.push_back(t);
}

bool lies_within(double s) { return s >= -margins::edge_margin && s <= 1 + margins::edge_margin; }

std::optional<SightLine> line_through(const PlaneFrame& emitter, const Vec3* points, int count,
                                      Vec3 direction) {
  direction.normalize();
  const double away = emitter.normal.dot(direction);
  if (!(std::abs(away) > margins::parallel_sine)) return std::nullopt;
  if (away < 0) direction = -direction;
  double least = HUGE_VAL, most = -HUGE_VAL;
  SightLine line{points[0], points[0], direction};
  for (int k = 0; k < count; ++k) {
    const double height = emitter.height(points[k]);
    if (height < least) {
      least = height;
      line.start = points[k];
    }
    if (height > most) {
      most = height;
      line.last = points[k];
    }
  }
  line.start -= least / std::abs(away) * direction;
  return line;
}

Eigen::AlignedBox3d box_of(const Vec3& a, const Vec3& b) {
  Eigen::AlignedBox3d box(a);
  box.extend(b);
  return box;
}

Interval times(const Interval& a, const Interval& b) {
  const double p = a[0] * b[0], q = a[0] * b[1], r = a[1] * b[0], s = a[1] * b[1];
  return {std::min({p, q, r, s}), std::max({p, q, r, s})};
}

/// In-plane parameter of the line through the apex and y.
void add_direction(const Swath& swath, const Vec3& normal, const Vec3& y, double slack,
                   std::vector<double>& parameters) {
  const Vec3 to = y - swath.apex;
  if (to.squaredNorm() <= slack * slack) return;
  // With the base as seen from y, for the apex may be far from both.
  const double t =
      normal.dot((swath.base.from - y).cross(to)) / normal.dot(to.cross(swath.base.direction()));
  if (t > 0 && t < 1) parameters.push_back(t);
}

}  // namespace

void set_edges(Swath& swath, const std::array<Span3, 3>& edges) {
  swath.is_planar = false;
  swath.edges = edges;
  std::array<Line3, 3> lines;
  for (std::size_t k = 0; k < 3; ++k) lines[k] = {edges[k].from, edges[k].direction()};
  swath.family = line_family(lines);
}

std::optional<SightLine> line_at(const Swath& swath, const PlaneFrame& emitter, double t) {
  if (swath.is_planar) {
    const std::array<Vec3, 2> points = {swath.apex, swath.base.at(t)};
    return line_through(emitter, points.data(), 2, points[1] - points[0]);
  }
  const double second = value(parameter_on(swath.family, 1), t);
  const double third = value(parameter_on(swath.family, 2), t);
  if (!lies_within(second) || !lies_within(third)) return std::nullopt;
  const std::array<Vec3, 3> points = {swath.edges[0].at(t), swath.edges[1].at(second),
                                      swath.edges[2].at(third)};
  return line_through(emitter, points.data(), 3, direction(swath.family, t));
}

void critical_parameters(const Swath& swath, const Span3& edge, double slack,
                         std::vector<double>& parameters) {
  if (!swath.is_planar) {
    add_roots(meeting(swath.family, {edge.from, edge.direction()}), parameters);
    return;
  }
  const Vec3 normal = plane_normal(swath);
  // From what is near the edge: the other may be so far away that its rounding shows.
  const bool apex_is_near =
      (swath.apex - edge.from).squaredNorm() <= (swath.base.from - edge.from).squaredNorm();
  const Vec3& in_plane = apex_is_near ? swath.apex : swath.base.from;
  const double from = normal.dot(edge.from - in_plane), to = normal.dot(edge.to - in_plane);
  if (std::abs(from) <= slack) add_direction(swath, normal, edge.from, slack, parameters);
  if (std::abs(to) <= slack) add_direction(swath, normal, edge.to, slack, parameters);
  if ((from > slack && to < -slack) || (from < -slack && to > slack))
    add_direction(swath, normal, edge.at(from / (from - to)), slack, parameters);
}

void own_limits(const Swath& swath, std::vector<double>& parameters) {
  for (const int i : {1, 2}) {
    const LinearRatio r = parameter_on(swath.family, i);
    add_roots({r.a, r.b, 0}, parameters);              // at the start of the edge
    add_roots({r.a - r.c, r.b - r.d, 0}, parameters);  // at its end
  }
}

void grazing_parameters(const Swath& swath, const Vec3& normal, std::vector<double>& parameters) {
  if (swath.is_planar)
    add_roots({normal.dot(swath.base.from - swath.apex), normal.dot(swath.base.direction()), 0},
              parameters);
  else
    add_roots(direction_along(swath.family, normal), parameters);
}

Vec3 plane_normal(const Swath& swath) { return plane_through(swath.apex, swath.base).normalized(); }

SwathBounds bounds_of(const Swath& swath, double t0, double t1) {
  SwathBounds bounds;
  if (swath.is_planar) {
    bounds.near = box_of(swath.apex, swath.apex);
    bounds.far = box_of(swath.base.at(t0), swath.base.at(t1));
    bounds.normal = plane_normal(swath);
    bounds.point = swath.apex;
    return bounds;
  }
  bounds.near = box_of(swath.edges[0].at(t0), swath.edges[0].at(t1));
  const auto reach = [&](int i) {
    const LinearRatio ratio = parameter_on(swath.family, i);
    const Span3& edge = swath.edges[at(i)];
    return box_of(edge.at(std::clamp(value(ratio, t0), 0., 1.)),
                  edge.at(std::clamp(value(ratio, t1), 0., 1.)));
  };
  const Eigen::AlignedBox3d second = reach(1), third = reach(2);
  const Vec3 x = bounds.near.center();
  bounds.far = (second.center() - x).norm() > (third.center() - x).norm() ? second : third;
  return bounds;
}

bool SwathBounds::meets(const Vec3& low, const Vec3& high, double slack) const {
  if (!normal.isZero()) {
    const Vec3 centre = 0.5 * (low + high), half = 0.5 * (high - low);
    if (std::abs(normal.dot(centre - point)) > normal.cwiseAbs().dot(half) + slack) return false;
  }
  // Along the axis that parts the two boxes best, every line is a linear function of the place.
  Eigen::Index axis = 0;
  const Vec3 gap = (near.min() - far.max()).cwiseMax(far.min() - near.max());
  if (!(gap.maxCoeff(&axis) > slack)) return true;
  const Interval across = {far.min()[axis] - near.max()[axis], far.max()[axis] - near.min()[axis]};
  const Interval along = {low[axis] - slack - near.max()[axis],
                          high[axis] + slack - near.min()[axis]};
  const Interval u = times(along, {1 / across[1], 1 / across[0]});
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (k == axis) continue;
    const Interval a = times({near.min()[k], near.max()[k]}, {1 - u[1], 1 - u[0]});
    const Interval b = times({far.min()[k], far.max()[k]}, u);
    if (a[0] + b[0] > high[k] + slack || a[1] + b[1] < low[k] - slack) return false;
  }
  return true;
}

std::optional<Trace> trace_at(const Swath& swath, const PlaneFrame& plane, double t) {
  // The line runs through x with direction d; dots are derivatives by t.
  Vec3 x, d, x_dot, d_dot;
  if (swath.is_planar) {
    const Vec3 on_base = swath.base.at(t);
    d = on_base - swath.apex;
    d_dot = swath.base.direction();
    // What is nearer to the plane is rounded less.
    const bool base_is_near = std::abs(plane.height(on_base)) < std::abs(plane.height(swath.apex));
    x = base_is_near ? on_base : swath.apex;
    x_dot = base_is_near ? d_dot : Vec3::Zero();
  } else {
    const LineFamily& f = swath.family;
    x = swath.edges[0].at(t);
    x_dot = swath.edges[0].direction();
    d = direction(f, t);
    d_dot = f.slope[0].cross(f.constant[1] + t * f.slope[1]) +
            (f.constant[0] + t * f.slope[0]).cross(f.slope[1]);
  }
  const double speed = plane.normal.dot(d), height = plane.height(x);
  if (!(std::abs(speed) > margins::parallel_sine * d.norm())) return std::nullopt;
  const double along = -height / speed;
  const double along_dot = -(plane.normal.dot(x_dot) + along * plane.normal.dot(d_dot)) / speed;
  return Trace{x + along * d, x_dot + along_dot * d + along * d_dot};
}

}  // namespace halfshade
