#include "meshing/arrangement/cocircular.h"

#include "meshing/geometry/corner_fans.h"
#include "meshing/geometry/planar_signs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace halfshade {
namespace {

/// How much coordinates may have been rounded by when they were made, as a part of the largest.
constexpr double rounding = 64 * 0x1p-53;
/// Parts that a circle's coordinates are rounded to for the choice of the leftmost point.
constexpr double parts = 0x1p20;

class TieSettler {
 public:
  TieSettler(std::span<const Vec2> points, const std::vector<std::array<bool, 3>>& constrained,
             HullTriangulation& hull)
      : points_(points), constrained_(constrained), hull_(hull) {
    for (const Vec2& p : points) largest_ = std::max(largest_, p.cwiseAbs().maxCoeff());
    group_.resize(hull.triangles.size());
    std::iota(group_.begin(), group_.end(), 0);
  }

  void run() {
    for (std::size_t t = 0; t < group_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const int next = hull_.neighbours[t][k];
        if (next > static_cast<int>(t) && !constrained_[t][k] && is_tie(t, k))
          group_[at(root(next))] = root(static_cast<int>(t));
      }
    std::map<int, std::vector<int>> members;
    for (int t = 0; t < static_cast<int>(group_.size()); ++t)
      if (const int r = root(t); r != t) members[r].push_back(t);
    for (auto& [r, others] : members) {
      others.push_back(r);
      fan_out(others);
    }
  }

 private:
  const Vec2& place(int p) const { return points_[at(p)]; }

  int root(int t) {
    while (group_[at(t)] != t) t = group_[at(t)] = group_[at(group_[at(t)])];
    return t;
  }

  /// Whether the corners of both triangles at an edge lie on one circle.
  bool is_tie(std::size_t t, std::size_t k) const {
    const auto& corner = hull_.triangles[t];
    const auto& other = hull_.triangles[at(hull_.neighbours[t][k])];
    const int from = corner[k], to = corner[(k + 1) % 3];
    const int beyond =
        *std::find_if(other.begin(), other.end(), [&](int p) { return p != from && p != to; });
    const Vec2 &a = place(from), &b = place(to), &c = place(corner[(k + 2) % 3]),
               &d = place(beyond);
    const Vec2 ca = a - c, cb = b - c, da = a - d, db = b - d;
    // The angles at c and d together, from a half turn.
    const double sine = (ca.x() * cb.y() - ca.y() * cb.x()) * db.dot(da) +
                        (db.x() * da.y() - db.y() * da.x()) * ca.dot(cb);
    const double shortest = std::min({ca.norm(), cb.norm(), da.norm(), db.norm(), (b - a).norm()});
    const double allowed = inside_circle + rounding * largest_ / shortest;
    return std::abs(sine) < allowed * ca.norm() * cb.norm() * da.norm() * db.norm();
  }

  /// Gives the triangles of a convex polygon a common corner.
  void fan_out(const std::vector<int>& triangles) {
    std::map<int, int> next;  // round the polygon
    std::size_t sides = 0;
    for (const int t : triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const int beyond = hull_.neighbours[at(t)][k];
        if (beyond >= 0 && root(beyond) == root(t) && !constrained_[at(t)][k]) continue;
        next[hull_.triangles[at(t)][k]] = hull_.triangles[at(t)][(k + 1) % 3];
        ++sides;
      }
    if (sides != triangles.size() + 2 || next.size() != sides) return;
    const int first = leftmost(next);
    std::vector<std::array<int, 3>> made;
    for (int p = next.at(first); next.at(p) != first && made.size() < triangles.size();
         p = next.at(p))
      made.push_back({first, p, next.at(p)});
    if (made.size() != triangles.size()) return;
    for (const auto& [a, b, c] : made)
      if (orientation(place(a), place(b), place(c)) <= 0) return;
    for (std::size_t i = 0; i < made.size(); ++i) hull_.triangles[at(triangles[i])] = made[i];
  }

  int leftmost(const std::map<int, int>& polygon) const {
    Vec2 low = place(polygon.begin()->first), high = low;
    for (const auto& [p, following] : polygon) {
      low = low.cwiseMin(place(p));
      high = high.cwiseMax(place(p));
    }
    const Vec2 middle = 0.5 * (low + high);
    const double unit = (high - low).maxCoeff() / parts;
    std::tuple<double, double, int> least{HUGE_VAL, HUGE_VAL, -1};
    for (const auto& [p, following] : polygon) {
      const Vec2 q = (place(p) - middle) / unit;
      least = std::min(least, {std::round(q.x()), -std::round(q.y()), p});
    }
    return std::get<2>(least);
  }

  std::span<const Vec2> points_;
  const std::vector<std::array<bool, 3>>& constrained_;
  HullTriangulation& hull_;
  double largest_ = 0;
  std::vector<int> group_;  // of triangles whose corners lie on one circle
};

}  // namespace

void settle_ties(std::span<const Vec2> points, const std::vector<std::array<bool, 3>>& constrained,
                 HullTriangulation& hull) {
  TieSettler(points, constrained, hull).run();
  for (auto& t : hull.triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(hull.triangles.begin(), hull.triangles.end());
  hull.neighbours = edge_neighbours(hull.triangles);
}

}  // namespace halfshade
