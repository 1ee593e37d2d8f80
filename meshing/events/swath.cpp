#include "meshing/events/swath.h"

#include "meshing/events/margins.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

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

/// Where the line from the apex through a point of the base meets the second edge.
double parameter_on_second(const Swath& swath, const Vec3& on_base) {
  const Vec3 normal = plane_normal(swath), across = normal.cross(on_base - swath.apex);
  return across.dot(on_base - swath.second->from) / across.dot(swath.second->direction());
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
    if (swath.second && !lies_within(parameter_on_second(swath, points[1]))) return std::nullopt;
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
  if (swath.is_planar) {
    if (!swath.second) return;
    const Vec3 normal = plane_normal(swath);
    for (const Vec3& end : {swath.second->from, swath.second->to})
      add_direction(swath, normal, end, 0, parameters);
    return;
  }
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

void feature_parameters(const Swath& swath, const Vec3& point, const Vec3& normal,
                        std::vector<double>& parameters) {
  const auto add = [&](const Span3& edge, const LinearRatio& along) {
    // along = s where the edge passes through the plane
    const double height = normal.dot(edge.from - point), slope = normal.dot(edge.direction());
    add_roots({slope * along.a + height * along.c, slope * along.b + height * along.d, 0},
              parameters);
  };
  if (swath.is_planar) return add(swath.base, {0, 1, 1, 0});
  add(swath.edges[0], {0, 1, 1, 0});
  for (const int i : {1, 2}) add(swath.edges[at(i)], parameter_on(swath.family, i));
}

Vec3 plane_normal(const Swath& swath) { return plane_through(swath.apex, swath.base).normalized(); }

SwathBounds bounds_of(const Swath& swath, double t0, double t1) {
  if (swath.is_planar)
    return {{bounds_of(swath.apex, swath.apex), bounds_of(swath.base.at(t0), swath.base.at(t1))},
            plane_normal(swath),
            swath.apex};
  const Bounds first = bounds_of(swath.edges[0].at(t0), swath.edges[0].at(t1));
  const auto reach = [&](int i) {
    const LinearRatio ratio = parameter_on(swath.family, i);
    const Span3& edge = swath.edges[at(i)];
    return bounds_of(edge.at(std::clamp(value(ratio, t0), 0., 1.)),
                     edge.at(std::clamp(value(ratio, t1), 0., 1.)));
  };
  const Bounds second = reach(1), third = reach(2);
  const Vec3 x = first.centre();
  return {{first, (second.centre() - x).norm() > (third.centre() - x).norm() ? second : third}};
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
