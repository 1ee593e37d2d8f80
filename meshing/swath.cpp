#include "meshing/swath.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

using Interval = std::array<double, 2>;

// Shares of an edge by which a line may miss it, from rounding.
constexpr double edge_margin = 1e-10;
// Lines flatter to the emitter than this do not come from it.
constexpr double flattest = 1e-12;

/// Normal of the plane through a point and an edge.
Vec3 plane_through(const Vec3& point, const Span3& edge) {
  return (edge.from - point).cross(edge.direction());
}

double determinant(const Vec3& a, const Vec3& b, const Vec3& c) { return a.cross(b).dot(c); }

/// Real roots of c0 + c1 t + c2 t² in (0,1).
void add_roots(double c0, double c1, double c2, std::vector<double>& roots) {
  const auto add = [&](double t) {
    if (t > 0 && t < 1) roots.push_back(t);
  };
  const double scale = std::max({std::abs(c0), std::abs(c1), std::abs(c2)});
  if (scale == 0) return;
  const double discriminant = c1 * c1 - 4 * c0 * c2;
  // A double root must not be lost to rounding: the line touches there.
  if (discriminant < -1e-14 * scale * scale) return;
  const double q = -0.5 * (c1 + std::copysign(std::sqrt(std::max(0., discriminant)), c1));
  if (q != 0) add(c0 / q);
  if (c2 != 0) add(q / c2);
}

/// Roots of a function that is a polynomial of degree 2 at most.
template <class Function>
void add_roots_of(Function&& f, std::vector<double>& roots) {
  const double f0 = f(0.), fh = f(0.5), f1 = f(1.);
  const double c2 = 2 * (f0 - 2 * fh + f1);
  add_roots(f0, f1 - f0 - c2, c2, roots);
}

/// Where the line through x that meets edges 1 and 2 does so, as shares of these edges.
struct Meeting {
  Vec3 direction;
  double on_second, on_third;
};
Meeting meet(const Swath& swath, const Vec3& x) {
  const Vec3 second = plane_through(x, swath.edges[1]), third = plane_through(x, swath.edges[2]);
  Meeting m{second.cross(third), 0, 0};
  m.on_second = third.dot(x - swath.edges[1].from) / third.dot(swath.edges[1].direction());
  m.on_third = second.dot(x - swath.edges[2].from) / second.dot(swath.edges[2].direction());
  return m;
}

bool lies_within(double s) { return s >= -edge_margin && s <= 1 + edge_margin; }

std::optional<SightLine> line_through(const PlaneFrame& emitter, const Vec3* points, int count,
                                      Vec3 direction) {
  direction.normalize();
  const double away = emitter.normal.dot(direction);
  if (!(std::abs(away) > flattest)) return std::nullopt;
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
  const double d0 = normal.dot((swath.base.from - swath.apex).cross(to));
  const double d1 = normal.dot((swath.base.to - swath.apex).cross(to));
  const double t = d0 / (d0 - d1);
  if (t > 0 && t < 1) parameters.push_back(t);
}

}  // namespace

std::optional<SightLine> line_at(const Swath& swath, const PlaneFrame& emitter, double t) {
  if (swath.is_planar) {
    const std::array<Vec3, 2> points = {swath.apex, swath.base.at(t)};
    return line_through(emitter, points.data(), 2, points[1] - points[0]);
  }
  const Vec3 x = swath.edges[0].at(t);
  const Meeting m = meet(swath, x);
  if (!lies_within(m.on_second) || !lies_within(m.on_third)) return std::nullopt;
  const std::array<Vec3, 3> points = {x, swath.edges[1].at(m.on_second),
                                      swath.edges[2].at(m.on_third)};
  return line_through(emitter, points.data(), 3, m.direction);
}

void critical_parameters(const Swath& swath, const Span3& edge, double slack,
                         std::vector<double>& parameters) {
  if (!swath.is_planar) {
    add_roots_of(
        [&](double t) {
          const Vec3 x = swath.edges[0].at(t);
          return determinant(plane_through(x, swath.edges[1]), plane_through(x, swath.edges[2]),
                             plane_through(x, edge));
        },
        parameters);
    return;
  }
  const Vec3 normal = plane_through(swath.apex, swath.base).normalized();
  const double from = normal.dot(edge.from - swath.apex), to = normal.dot(edge.to - swath.apex);
  if (std::abs(from) <= slack) add_direction(swath, normal, edge.from, slack, parameters);
  if (std::abs(to) <= slack) add_direction(swath, normal, edge.to, slack, parameters);
  if ((from > slack && to < -slack) || (from < -slack && to > slack))
    add_direction(swath, normal, edge.at(from / (from - to)), slack, parameters);
}

void own_limits(const Swath& swath, std::vector<double>& parameters) {
  for (const auto& [own, other] : {std::array{1, 2}, std::array{2, 1}}) {
    const Span3& edge = swath.edges[static_cast<std::size_t>(own)];
    const Span3& guide = swath.edges[static_cast<std::size_t>(other)];
    for (const Vec3& end : {edge.from, edge.to})
      add_roots_of(
          [&](double t) {
            const Vec3 x = swath.edges[0].at(t);
            return plane_through(x, guide).dot(x - end);
          },
          parameters);
  }
}

void grazing_parameters(const Swath& swath, const Vec3& normal, std::vector<double>& parameters) {
  add_roots_of(
      [&](double t) {
        if (swath.is_planar) return normal.dot(swath.base.at(t) - swath.apex);
        const Vec3 x = swath.edges[0].at(t);
        return normal.dot(plane_through(x, swath.edges[1]).cross(plane_through(x, swath.edges[2])));
      },
      parameters);
}

SwathHull hull_of(const Swath& swath, double t0, double t1) {
  SwathHull hull;
  if (swath.is_planar) {
    hull.near = box_of(swath.apex, swath.apex);
    hull.far = box_of(swath.base.at(t0), swath.base.at(t1));
    hull.normal = plane_through(swath.apex, swath.base).normalized();
    hull.point = swath.apex;
    return hull;
  }
  const Vec3 x0 = swath.edges[0].at(t0), x1 = swath.edges[0].at(t1);
  const Meeting m0 = meet(swath, x0), m1 = meet(swath, x1);
  hull.near = box_of(x0, x1);
  const auto on = [](const Span3& edge, double s) { return edge.at(std::clamp(s, 0., 1.)); };
  const auto second = box_of(on(swath.edges[1], m0.on_second), on(swath.edges[1], m1.on_second));
  const auto third = box_of(on(swath.edges[2], m0.on_third), on(swath.edges[2], m1.on_third));
  const Vec3 x = hull.near.center();
  hull.far = (second.center() - x).norm() > (third.center() - x).norm() ? second : third;
  return hull;
}

bool SwathHull::meets(const Vec3& low, const Vec3& high, double slack) const {
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
    x = swath.apex;
    d = swath.base.at(t) - x;
    x_dot = Vec3::Zero();
    d_dot = swath.base.direction();
  } else {
    const Span3 &second = swath.edges[1], &third = swath.edges[2];
    x = swath.edges[0].at(t);
    x_dot = swath.edges[0].direction();
    const Vec3 n = plane_through(x, second), m = plane_through(x, third);
    d = n.cross(m);
    d_dot = -x_dot.cross(second.direction()).cross(m) - n.cross(x_dot.cross(third.direction()));
  }
  const double speed = plane.normal.dot(d), height = plane.height(x);
  if (!(std::abs(speed) > flattest * d.norm())) return std::nullopt;
  const double along = -height / speed;
  const double along_dot = -(plane.normal.dot(x_dot) + along * plane.normal.dot(d_dot)) / speed;
  return Trace{x + along * d, x_dot + along_dot * d + along * d_dot};
}

}  // namespace halfshade
