#include "solver/factors/blocked_cell.h"

#include "meshing/geometry/shaft.h"
#include "solver/elements/quadrature.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace halfshade {
namespace {

constexpr int exact_degree = 99;
/// Of what could hide something from points between those looked at, this share is the error where
/// none of them found anything: a first guess from how far apart they lie.
constexpr double share_of_unseen = 0.5;
/// The same of what might be seen through gaps, where nothing is seen; by how often it was looked.
constexpr std::array<double, 3> share_of_gaps = {0.1, 0.01, 0};
/// Of the spread of values, what a first cell may be off by, though two rules agree by chance; half
/// of it after each halving.
constexpr double share_of_spread = 0.1;

double area_of(const Triangle3& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

Polygon3 clipped(Polygon3 polygon, const Shaft& shaft) {
  for (const Shaft::Side& side : shaft.sides) {
    if (polygon.empty()) break;
    polygon = clip_to_front(polygon, side.limit * side.normal, -side.normal);
  }
  return polygon;
}

/// From a point to either side of a polygon.
double factor_to(const Vec3& point, const Vec3& normal, const Polygon3& polygon) {
  const Polygon3 turned(polygon.rbegin(), polygon.rend());
  return std::max(point_to_polygon(point, normal, polygon),
                  point_to_polygon(point, normal, turned));
}

Vec3 middle_of(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Mutual area of a cell and what may hide something from it, seen from both: one of them has
/// points near enough to see it well.
double hidden_by(const Triangle3& cell, const Vec3& normal, const Polygon3& blocker) {
  const Vec3 blocker_area = area_vector(blocker);
  const double size = blocker_area.norm();
  if (!(size > 0)) return 0;
  double most = factor_to(middle_of(cell), normal, blocker);
  for (const Vec3& corner : cell) most = std::max(most, factor_to(corner, normal, blocker));
  const Polygon3 outline(cell.begin(), cell.end());
  const Vec3 middle = middle_of(blocker), up = blocker_area / size;
  const double seen = std::max(factor_to(middle, up, outline), factor_to(middle, -up, outline));
  return std::max(area_of(cell) * most, size * seen);
}

}  // namespace

/// Means over a cell.
struct BlockedCells::Sum {
  double hidden = 0, unobstructed = 0;
  double least = HUGE_VAL, most = -HUGE_VAL;  // of what is hidden
  bool is_lit = true, is_dark = true, is_smooth = true;
  std::uint64_t signature = 0;
};

BlockedCells::Sum BlockedCells::sum_over(const Triangle3& corners, int degree) {
  const Vec3& normal = scene_.surfaces[at(a_)].frame.normal;
  const Vec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
  Sum sum;
  bool is_first = true;
  for (const TriangleNode& node : triangle_rule(degree)) {
    const PointFactor factor =
        scene_.light.factor({corners[0] + node.u * u + node.v * v, normal}, b_);
    ++points_;
    const double hidden = factor.unobstructed - factor.visible;
    sum.hidden += node.weight * hidden;
    sum.unobstructed += node.weight * factor.unobstructed;
    sum.least = std::min(sum.least, hidden);
    sum.most = std::max(sum.most, hidden);
    sum.is_lit = sum.is_lit && hidden == 0;
    sum.is_dark = sum.is_dark && factor.visible == 0;
    if (is_first) sum.signature = factor.signature;
    sum.is_smooth = sum.is_smooth && factor.signature == sum.signature;
    is_first = false;
  }
  return sum;
}

/// What may hide `b` from the cell, though none of its points found anything: 0 if nothing comes
/// between, else by what the cell sees of what reaches into the hull of the two.
double BlockedCells::unseen(const Triangle3& corners, double seen) const {
  const PlaneFrame& plane = scene_.surfaces[at(a_)].frame;
  double sum = 0;
  for (const Polygon3& piece : scene_.surfaces[at(b_)].pieces) {
    const Polygon3 other = clip_to_front(piece, plane.origin, plane.normal);
    if (other.empty()) continue;
    const std::vector<int> roots = roots_between(scene_, corners, a_, other, b_);
    if (roots.empty()) continue;
    const Shaft shaft = make_shaft(corners, other, 0);
    for (const int root : roots) {
      const Triangle3 triangle = scene_.reflecting.roots.triangle(root);
      const Polygon3 between = clipped({triangle.begin(), triangle.end()}, shaft);
      if (!between.empty()) sum += hidden_by(corners, plane.normal, between);
    }
  }
  return share_of_unseen * std::min(sum, seen);
}

BlockedCell BlockedCells::evaluate(const BlockedCell& from, int degree) {
  const Triangle3& corners = from.corners;
  const int lower = degree == 2 ? 1 : degree == 4 ? 2 : 4;
  const Sum low = sum_over(corners, lower), high = sum_over(corners, degree);
  const double area = area_of(corners);
  BlockedCell cell{corners, degree};
  cell.value = area * high.hidden;
  cell.error = area * std::abs(high.hidden - low.hidden);
  cell.is_smooth = low.is_smooth && high.is_smooth && low.signature == high.signature;
  cell.halvings = from.halvings;
  if (degree == 2 || !cell.is_smooth) {
    const double spread = std::max(low.most, high.most) - std::min(low.least, high.least);
    cell.error = std::max(cell.error, std::ldexp(share_of_spread, -from.halvings) * area * spread);
  }
  const bool is_lit = low.is_lit && high.is_lit;
  if (is_lit || degree == 2) {
    const double missed = unseen(corners, area * high.unobstructed) - cell.value;
    cell.error = is_lit ? missed : std::max(cell.error, missed);
  }
  if (low.is_dark && high.is_dark && !is_lit) {
    cell.is_dark = true;
    cell.dark_levels = from.dark_levels + 1;
    const std::size_t level = std::min(at(from.dark_levels), share_of_gaps.size() - 1);
    cell.error += share_of_gaps[level] * area * high.unobstructed;
  }
  return cell;
}

BlockedCell BlockedCells::closed_form(const BlockedCell& dark) const {
  SightTolerance fine = tolerance_;
  fine.absolute *= 1e-3;
  const MutualSight all = clear_sight(scene_, dark.corners, b_, fine);
  BlockedCell cell = dark;
  cell.degree = exact_degree;
  cell.value = all.value;
  cell.error = all.error;
  return cell;
}

BlockedCell BlockedCells::look(const Triangle3& corners) { return evaluate({corners}, 2); }

void BlockedCells::refine(const BlockedCell& cell, std::vector<BlockedCell>& next) {
  next.clear();
  if (cell.is_dark && cell.dark_levels >= static_cast<int>(share_of_gaps.size()) &&
      cell.degree != exact_degree)
    return next.push_back(closed_form(cell));
  const bool is_found = cell.value != 0;
  if (is_found && (cell.degree < 4 || (cell.degree == 4 && (cell.is_smooth || cell.is_dark))))
    return next.push_back(evaluate(cell, cell.degree == 2 ? 4 : 6));
  std::size_t longest = 0;
  const auto length = [&](std::size_t k) {
    return (cell.corners[(k + 1) % 3] - cell.corners[k]).squaredNorm();
  };
  for (std::size_t k = 1; k < 3; ++k)
    if (length(k) > length(longest)) longest = k;
  const Vec3 &p = cell.corners[longest], &q = cell.corners[(longest + 1) % 3],
             &r = cell.corners[(longest + 2) % 3];
  const Vec3 middle = 0.5 * (p + q);
  const int degree = is_found ? 4 : 2;
  BlockedCell half = cell;
  ++half.halvings;
  for (const Triangle3& corners : {Triangle3{p, middle, r}, Triangle3{middle, q, r}}) {
    half.corners = corners;
    next.push_back(evaluate(half, degree));
  }
}

}  // namespace halfshade
