#include "meshing/geometry/shaft.h"

#include "meshing/core/planar.h"
#include "meshing/core/plane_frame.h"
#include "meshing/geometry/convex_hull.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace halfshade {
namespace {

// More edges of a polygon than this cost more in tests than they save in candidates.
constexpr std::size_t most_edges = 16;  // two sides each, two polygons: 64 bits

// Relative to the shaft's size. Any half-space that touches the hull is valid, so this decides how
// tight the shaft is, not whether it is right.
constexpr double tightness = 1e-9;

// Squared difference of unit normals that are one but for rounding.
constexpr double same_normal_sine = 1e-26;

using Edge = std::pair<Vec3, Vec3>;

/// The edges of a polygon's convex hull: none for a point, one for a polygon without area.
std::vector<Edge> hull_edges(std::span<const Vec3> polygon) {
  const Vec3& p = polygon.front();
  const auto farthest = [&](const Vec3& from) {
    return *std::max_element(polygon.begin(), polygon.end(), [&](const Vec3& x, const Vec3& y) {
      return (x - from).squaredNorm() < (y - from).squaredNorm();
    });
  };
  const Vec3 q = farthest(p), r = farthest(q);
  const double length = (q - r).norm();
  if (!(length > 0)) return {};
  const Vec3 area = area_vector(polygon);
  if (!(area.norm() > tightness * length * length)) return {{q, r}};
  const PlaneFrame frame = make_frame(p, area);
  std::vector<Vec2> flat;
  for (const Vec3& x : polygon) flat.push_back(frame.to_plane(x));
  const auto hull = convex_hull(flat);
  const std::size_t step = (hull.size() + most_edges - 1) / most_edges;
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < hull.size(); i += step)
    edges.emplace_back(polygon[hull[i]], polygon[hull[(i + 1) % hull.size()]]);
  return edges;
}

/// Grows with the angle from `axis` to v, from −2 to 2, without trigonometric functions.
double pseudo_angle(const Vec2& axis, const Vec2& v) {
  const double s = cross_2d(axis, v), c = axis.dot(v);
  const double t = s / (std::abs(s) + std::abs(c));
  return c >= 0 ? t : (s >= 0 ? 2 : -2) - t;
}

void add_side(Shaft& shaft, const Vec3& normal, const Vec3& touched, double slack) {
  Shaft::Side side{normal, -std::numeric_limits<double>::infinity()};
  for (const Vec3& p : shaft.corners) side.limit = std::max(side.limit, normal.dot(p));
  if (side.limit - normal.dot(touched) > slack) return;
  for (const Shaft::Side& other : shaft.sides)
    if ((other.normal - normal).squaredNorm() < same_normal_sine) return;
  shaft.sides.push_back(side);
}

/// Adds the two facets of the hull that meet in an edge, if it is an edge of the hull: seen along
/// the edge they are the tangents from a point to the other corners.
void add_tangents(Shaft& shaft, const Edge& edge, double slack, std::vector<Vec2>& seen) {
  const PlaneFrame along = make_frame(edge.first, edge.second - edge.first);
  seen.clear();
  Vec2 middle = Vec2::Zero();
  for (const Vec3& p : shaft.corners) {
    const Vec2 v = along.to_plane(p);
    const double length = v.norm();
    if (length <= slack) continue;
    seen.push_back(v / length);
    middle += seen.back();
  }
  if (seen.empty()) return;
  if (middle.squaredNorm() < tightness) middle = {-seen.front().y(), seen.front().x()};
  const auto [low, high] =
      std::minmax_element(seen.begin(), seen.end(), [&](const Vec2& v, const Vec2& w) {
        return pseudo_angle(middle, v) < pseudo_angle(middle, w);
      });
  add_side(shaft, low->y() * along.e1 - low->x() * along.e2, edge.first, slack);
  add_side(shaft, high->x() * along.e2 - high->y() * along.e1, edge.first, slack);
}

}  // namespace

Shaft make_shaft(std::span<const Vec3> a, std::span<const Vec3> b, double tolerance) {
  Shaft shaft;
  shaft.tolerance = tolerance;
  shaft.corners.assign(a.begin(), a.end());
  shaft.corners.insert(shaft.corners.end(), b.begin(), b.end());
  shaft.low = shaft.high = a.front();
  for (const Vec3& p : shaft.corners) {
    shaft.low = shaft.low.cwiseMin(p);
    shaft.high = shaft.high.cwiseMax(p);
  }
  const double slack = tightness * (shaft.high - shaft.low).norm();
  const std::vector<Edge> edges_a = hull_edges(a), edges_b = hull_edges(b);
  std::vector<Vec2> seen;
  for (const auto* edges : {&edges_a, &edges_b})
    for (const Edge& edge : *edges) add_tangents(shaft, edge, slack, seen);
  if (edges_a.empty() && edges_b.empty() && slack > 0) {
    const PlaneFrame along = make_frame(a.front(), b.front() - a.front());
    for (const Vec3& normal : {along.e1, along.e2})
      for (const double sign : {-1.0, 1.0}) add_side(shaft, sign * normal, a.front(), slack);
  }
  return shaft;
}

double shaft_tolerance(std::span<const Vec3> a, std::span<const Vec3> b) {
  constexpr double touching = 1e-12, roundings = 16;
  Vec3 low = a.front(), high = a.front();
  for (const auto& polygon : {a, b})
    for (const Vec3& p : polygon) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  const double reach = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
  return touching * (high - low).maxCoeff() +
         roundings * std::numeric_limits<double>::epsilon() * reach;
}

SideMask all_sides(const Shaft& shaft) {
  const std::size_t n = shaft.sides.size();
  return n < 64 ? (SideMask{1} << n) - 1 : ~SideMask{0};
}

bool is_outside(const Shaft& shaft, const Vec3& low, const Vec3& high, SideMask& mask) {
  if ((low.array() >= shaft.high.array() - shaft.tolerance).any() ||
      (high.array() <= shaft.low.array() + shaft.tolerance).any())
    return true;
  for (SideMask rest = mask; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const Shaft::Side& side = shaft.sides[static_cast<std::size_t>(i)];
    double least = 0, most = 0;  // of normal · x over the box
    for (int axis = 0; axis < 3; ++axis) {
      const double x = side.normal[axis] * low[axis], y = side.normal[axis] * high[axis];
      least += std::min(x, y);
      most += std::max(x, y);
    }
    if (least >= side.limit - shaft.tolerance) return true;
    if (most <= side.limit - shaft.tolerance) mask &= ~(SideMask{1} << i);
  }
  return false;
}

bool is_harmless(const Shaft& shaft, const std::array<Vec3, 3>& triangle, SideMask mask) {
  const auto& [p, q, r] = triangle;
  if ((p.cwiseMin(q).cwiseMin(r).array() >= shaft.high.array() - shaft.tolerance).any() ||
      (p.cwiseMax(q).cwiseMax(r).array() <= shaft.low.array() + shaft.tolerance).any())
    return true;
  for (SideMask rest = mask; rest != 0; rest &= rest - 1) {
    const Shaft::Side& side = shaft.sides[static_cast<std::size_t>(std::countr_zero(rest))];
    const double outside = side.limit - shaft.tolerance;
    if (side.normal.dot(p) >= outside && side.normal.dot(q) >= outside &&
        side.normal.dot(r) >= outside)
      return true;
  }
  const Vec3 normal = (q - p).cross(r - p);
  const double touch = shaft.tolerance * normal.norm();
  bool front = false, behind = false;
  for (const Vec3& corner : shaft.corners) {
    const double height = normal.dot(corner - p);
    front = front || height > touch;
    behind = behind || height < -touch;
    if (front && behind) return false;
  }
  return true;
}

}  // namespace halfshade
