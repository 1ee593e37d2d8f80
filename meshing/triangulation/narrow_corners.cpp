#include "meshing/triangulation/narrow_corners.h"

#include "meshing/core/planar.h"
#include "meshing/triangulation/margins.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace halfshade {
namespace {

std::uint64_t key(int a, int b) {
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
}

double direction(const Vec2& from, const Vec2& to) {
  return std::atan2(to.y() - from.y(), to.x() - from.x());
}

double turned(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

double angle(const Vec2& apex, const Vec2& a, const Vec2& b) {
  const Vec2 u = a - apex, v = b - apex;
  return std::atan2(cross_2d(u, v), u.dot(v));
}

}  // namespace

NarrowCorners::NarrowCorners(const ConstrainedMesh& mesh) {
  unite_straight_constraints(mesh);
  find_corners(mesh);
  std::sort(narrow_.begin(), narrow_.end());
}

std::vector<NarrowCorners::End> NarrowCorners::list_ends(const ConstrainedMesh& mesh) {
  std::vector<End> ends;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t.corner[k], b = t.corner[(k + 1) % 3];
      if (t.constraint[k] < 0 || (t.neighbour[k] >= 0 && a > b)) continue;
      ends.push_back({a, direction(mesh.point(a), mesh.point(b)), t.constraint[k]});
      ends.push_back({b, direction(mesh.point(b), mesh.point(a)), t.constraint[k]});
    }
  std::sort(ends.begin(), ends.end());
  first_.assign(mesh.points.size() + 1, 0);
  int constraint_count = 0;
  for (const End& end : ends) {
    ++first_[at(end.point) + 1];
    constraints_.push_back(end.constraint);
    constraint_count = std::max(constraint_count, end.constraint + 1);
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  chain_.resize(at(constraint_count));
  std::iota(chain_.begin(), chain_.end(), 0);
  return ends;
}

// The end at the same point that leaves most nearly the opposite way.
std::size_t NarrowCorners::opposite(const std::vector<End>& ends, std::size_t i) const {
  const auto begin = ends.begin() + first_[at(ends[i].point)];
  const auto end = ends.begin() + first_[at(ends[i].point) + 1];
  const double back = std::remainder(ends[i].direction + std::numbers::pi, 2 * std::numbers::pi);
  auto next = std::lower_bound(begin, end, back,
                               [](const End& e, double value) { return e.direction < value; });
  if (next == end) next = begin;
  const auto previous = next == begin ? end - 1 : next - 1;
  const bool is_previous = turned(previous->direction, back) <= turned(next->direction, back);
  return static_cast<std::size_t>((is_previous ? previous : next) - ends.begin());
}

void NarrowCorners::unite_straight_constraints(const ConstrainedMesh& mesh) {
  const std::vector<End> ends = list_ends(mesh);
  const auto root = [&](int constraint) {
    while (chain_[at(constraint)] != constraint)
      constraint = chain_[at(constraint)] = chain_[at(chain_[at(constraint)])];
    return constraint;
  };
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const std::size_t j = opposite(ends, i);
    if (i < j && opposite(ends, j) == i &&
        turned(ends[i].direction + std::numbers::pi, ends[j].direction) < margins::straight)
      chain_[at(root(ends[j].constraint))] = root(ends[i].constraint);
  }
  for (int& constraint : chain_) constraint = root(constraint);
}

void NarrowCorners::find_corners(const ConstrainedMesh& mesh) {
  for (std::size_t first = 0; first < mesh.triangles.size(); ++first)
    for (std::size_t side = 0; side < 3; ++side) {
      const int start = mesh.triangles[first].constraint[side];
      if (start < 0) continue;
      const int apex = mesh.triangles[first].corner[side];
      double sum = 0;
      int t = static_cast<int>(first), end = -1;
      std::size_t k = side;
      while (end < 0 && t >= 0 && sum < margins::narrow) {
        const auto& triangle = mesh.triangle(t);
        sum += angle(mesh.point(apex), mesh.point(triangle.corner[(k + 1) % 3]),
                     mesh.point(triangle.corner[(k + 2) % 3]));
        end = triangle.constraint[(k + 2) % 3];
        t = triangle.neighbour[(k + 2) % 3];
        if (end >= 0 || t < 0) break;
        const auto& corner = mesh.triangle(t).corner;
        k = static_cast<std::size_t>(std::find(corner.begin(), corner.end(), apex) -
                                     corner.begin());
      }
      if (end < 0 || sum >= margins::narrow) continue;
      narrow_.push_back(key(start, apex));
      narrow_.push_back(key(end, apex));
      corner_.try_emplace(key(chain_[at(start)], chain_[at(end)]), apex);
      corner_.try_emplace(key(chain_[at(end)], chain_[at(start)]), apex);
    }
}

bool NarrowCorners::is_narrow_at(int constraint, int point) const {
  return std::binary_search(narrow_.begin(), narrow_.end(), key(constraint, point));
}

void NarrowCorners::constraints_at(int point, int constraint, std::vector<int>& constraints) const {
  constraints.clear();
  if (constraint >= 0)
    constraints.push_back(constraint);
  else if (at(point) + 1 < first_.size())
    constraints.assign(constraints_.begin() + first_[at(point)],
                       constraints_.begin() + first_[at(point) + 1]);
}

bool NarrowCorners::are_twins(const ConstrainedMesh& mesh, int a, int constraint_of_a, int b,
                              int constraint_of_b) const {
  std::vector<int> constraints_a, constraints_b;
  constraints_at(a, constraint_of_a, constraints_a);
  constraints_at(b, constraint_of_b, constraints_b);
  for (const int m : constraints_a)
    for (const int n : constraints_b) {
      const auto found = corner_.find(key(chain_[at(m)], chain_[at(n)]));
      if (found == corner_.end()) continue;
      const Vec2& apex = mesh.point(found->second);
      const double p = (mesh.point(a) - apex).norm(), q = (mesh.point(b) - apex).norm();
      if (p > 0 && q > 0 && std::abs(p - q) < margins::twins * p) return true;
    }
  return false;
}

}  // namespace halfshade
