#include "meshing/triangulation/constrained_mesh.h"

#include "meshing/arrangement/cocircular.h"
#include "meshing/core/planar.h"
#include "meshing/geometry/planar_signs.h"
#include "meshing/triangulation/margins.h"

#include <algorithm>

namespace halfshade {
namespace {

// A way past more triangles than this starts at a needle in fine surroundings; those come first.
constexpr int most_steps = 500;

bool is_split(const ConstrainedMesh::Triangle& t, std::size_t k, const std::array<int, 2>& ends) {
  const int a = t.corner[k], b = t.corner[(k + 1) % 3];
  return (a == ends[0] && b == ends[1]) || (a == ends[1] && b == ends[0]);
}

// Whether p lies clearly in the circle through a, b and c, which is on the other side of ab: they
// see it under angles that come to more than a half turn.
bool is_in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& p) {
  const Vec2 pa = a - p, pb = b - p, ca = a - c, cb = b - c;
  const double x = pa.dot(pb), y = cross_2d(pa, pb), u = ca.dot(cb), v = cross_2d(cb, ca);
  const double cosine = x * u - y * v, sine = x * v + y * u;
  return sine < 0 && -sine > inside_circle * -cosine;
}

// Whether p, in the plane of a triangle, lies on one of its constraints or beyond it but for
// rounding.
bool is_on_line(const Vec2& a, const Vec2& b, const Vec2& p) {
  return cross_2d(b - a, p - a) <= margins::on_line * (b - a).squaredNorm();
}

}  // namespace

std::optional<Arrival> walk(const ConstrainedMesh& mesh, int triangle, const Vec2& target) {
  const auto& start = mesh.triangle(triangle).corner;
  const Vec2 from = (mesh.point(start[0]) + mesh.point(start[1]) + mesh.point(start[2])) / 3;
  int previous = -1;
  for (int step = 0; step < most_steps; ++step) {
    const auto& t = mesh.triangle(triangle);
    std::optional<std::size_t> exit;
    for (std::size_t k = 0; k < 3 && !exit; ++k) {
      if (t.neighbour[k] >= 0 && t.neighbour[k] == previous) continue;
      const Vec2 &u = mesh.point(t.corner[k]), &w = mesh.point(t.corner[(k + 1) % 3]);
      if (orientation(u, w, target) < 0 && orientation(from, target, u) <= 0 &&
          orientation(from, target, w) >= 0)
        exit = k;
    }
    if (!exit) {
      for (std::size_t k = 0; k < 3; ++k)
        if (orientation(mesh.point(t.corner[k]), mesh.point(t.corner[(k + 1) % 3]), target) < 0)
          return {};
      for (std::size_t k = 0; k < 3; ++k)
        if ((t.neighbour[k] < 0 || t.constraint[k] >= 0) &&
            is_on_line(mesh.point(t.corner[k]), mesh.point(t.corner[(k + 1) % 3]), target))
          return Arrival{{triangle, k}, true};
      return Arrival{{triangle, 0}, false};
    }
    if (t.neighbour[*exit] < 0 || t.constraint[*exit] >= 0) return Arrival{{triangle, *exit}, true};
    previous = triangle;
    triangle = t.neighbour[*exit];
  }
  return {};
}

void Cavity::find(const Vec2& p, int triangle) {
  p_ = p;
  split_ends_ = {-1, -1};
  inside_ = {triangle};
  grow();
}

void Cavity::find(const Vec2& p, const Side& split) {
  p_ = p;
  const auto& t = mesh_.triangle(split.triangle);
  split_ends_ = {t.corner[split.k], t.corner[(split.k + 1) % 3]};
  split_constraint_ = t.constraint[split.k];
  inside_ = {split.triangle};
  if (t.neighbour[split.k] >= 0) inside_.push_back(t.neighbour[split.k]);
  grow();
}

void Cavity::grow() {
  mark_.resize(mesh_.triangles.size(), 0);
  ++number_;
  for (const int t : inside_) mark_[at(t)] = number_;
  rim_.clear();
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    const auto& t = mesh_.triangle(inside_[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (is_split(t, k, split_ends_)) continue;
      const int next = t.neighbour[k];
      if (next >= 0 && t.constraint[k] < 0) {
        if (mark_[at(next)] == number_) continue;
        const auto& corner = mesh_.triangle(next).corner;
        const int from = t.corner[k], to = t.corner[(k + 1) % 3];
        const int beyond = *std::find_if(corner.begin(), corner.end(),
                                         [&](int c) { return c != from && c != to; });
        if (is_in_circle(mesh_.point(from), mesh_.point(to), mesh_.point(beyond), p_)) {
          mark_[at(next)] = number_;
          inside_.push_back(next);
          continue;
        }
      }
      rim_.push_back({{inside_[i], k}, t.corner[k], t.corner[(k + 1) % 3], next, t.constraint[k]});
    }
  }
}

bool Cavity::fill(std::vector<int>& changed) {
  for (const Rim& r : rim_)
    if (orientation(p_, mesh_.point(r.from), mesh_.point(r.to)) <= 0) return false;
  const int point = static_cast<int>(mesh_.points.size());
  mesh_.points.push_back(p_);
  starting_at_.resize(mesh_.points.size(), -1);
  changed.clear();
  const auto constraint_to = [&](int vertex) {
    return vertex == split_ends_[0] || vertex == split_ends_[1] ? split_constraint_ : -1;
  };
  for (std::size_t i = 0; i < rim_.size(); ++i) {
    const Rim& r = rim_[i];
    if (i >= inside_.size()) {
      inside_.push_back(static_cast<int>(mesh_.triangles.size()));
      mesh_.triangles.emplace_back();
    }
    const int t = inside_[i];
    changed.push_back(t);
    mesh_.triangles[at(t)] = {{point, r.from, r.to},
                              {-1, r.beyond, -1},
                              {constraint_to(r.from), r.constraint, constraint_to(r.to)}};
    starting_at_[at(r.from)] = t;
    if (r.beyond < 0) continue;
    auto& other = mesh_.triangles[at(r.beyond)];
    for (std::size_t k = 0; k < 3; ++k)
      if (other.corner[k] == r.to && other.corner[(k + 1) % 3] == r.from) other.neighbour[k] = t;
  }
  for (const int t : changed) {
    const int next = starting_at(mesh_.triangle(t).corner[2]);
    mesh_.triangles[at(t)].neighbour[2] = next;
    if (next >= 0) mesh_.triangles[at(next)].neighbour[0] = t;
  }
  for (const Rim& r : rim_) starting_at_[at(r.from)] = -1;
  return true;
}

}  // namespace halfshade
