#include "meshing/arrangement/snap_graph.h"

#include "meshing/core/planar.h"
#include "meshing/core/rounded.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

// Of the snap distance: how close points come to fixed edges before they are put on them.
constexpr double edge_share = 0.5;
// Relative to coordinates: points closer to a fixed edge than this lie on it.
constexpr double roundings = 8 * 0x1p-53;
// Of the snap distance: far below what matters, and far above what rounding does to most points.
constexpr double rounding_of_snap = 0x1p-20;

std::uint64_t pair_key(int a, int b) {
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
}

// Whether p and q lie on both sides of the line through a and b, farther from it than `width`.
bool are_parted(const Vec2& p, const Vec2& q, const Vec2& a, const Vec2& b, double width) {
  const double at_p = cross_2d(b - a, p - a), at_q = cross_2d(b - a, q - a);
  return (at_p > 0) != (at_q > 0) &&
         std::min(std::abs(at_p), std::abs(at_q)) > width * (b - a).norm();
}

// Whether two segments cross, and do not only touch but for rounding.
bool clearly_cross(const Vec2& p, const Vec2& q, const Vec2& a, const Vec2& b, double width) {
  return are_parted(p, q, a, b, width) && are_parted(a, b, p, q, width);
}

}  // namespace

SnapGraph::SnapGraph(double snap) : snap_(snap), grid_(snap) {}

int SnapGraph::new_point(const Vec2& p) {
  const int point = static_cast<int>(points_.size());
  points_.push_back(p);
  is_fixed_point_.push_back(false);
  is_fresh_point_.push_back(true);
  grid_.add(point, p);
  return point;
}

int SnapGraph::add_fixed_point(const Vec2& p) {
  const int point = new_point(p);
  is_fixed_point_[at(point)] = true;
  return point;
}

int SnapGraph::add_edge(int a, int b, bool is_fixed) {
  if (a > b) std::swap(a, b);
  const auto [entry, is_new] =
      edge_of_.try_emplace(pair_key(a, b), static_cast<int>(edges_.size()));
  if (is_new) edges_.push_back({a, b, is_fixed});
  if (!is_fixed || edge(entry->second).is_fixed) return entry->second;
  // Lines already ran along it.
  if (edge(entry->second).part_count == 0) {
    edge(entry->second).is_fixed = edge(entry->second).is_uncrossed = true;
  } else {  // ... and were led through a point beside it, where it cannot follow
    entry->second = static_cast<int>(edges_.size());
    edges_.push_back({a, b, true});
  }
  return entry->second;
}

int SnapGraph::edge_between(int a, int b) const {
  const auto found = edge_of_.find(pair_key(std::min(a, b), std::max(a, b)));
  return found != edge_of_.end() && edge(found->second).part_count == 0 ? found->second : -1;
}

int SnapGraph::add_fixed_edge(int a, int b) {
  fixed_tree_.reset();
  return add_edge(a, b, true);
}

int SnapGraph::add_line(const Vec2& from, const Vec2& to, double merge) {
  const int a = point_for(from, merge, {-1, -1, -1, -1}),
            b = point_for(to, merge, {-1, -1, -1, -1});
  return a == b ? -1 : add_edge(a, b, false);
}

void SnapGraph::index_fixed_edges() {
  std::vector<Bounds> boxes;
  indexed_.clear();
  for (const int e : present())
    if (edge(e).is_fixed) {
      indexed_.push_back(e);
      boxes.push_back(flat_bounds(place(edge(e).a), place(edge(e).b)));
    }
  fixed_tree_ = make_flat_tree(boxes, 1);
}

int SnapGraph::nearest_fixed_edge(const Vec2& p, double radius) {
  if (!fixed_tree_) index_fixed_edges();
  int best = -1;
  double closest = HUGE_VAL;
  visit_overlaps(*fixed_tree_, flat_bounds(p, p).grown(radius), [&](int i) {
    const Edge& e = edge(indexed_[at(i)]);
    const double distance = distance_to_segment(p, place(e.a), place(e.b));
    if (!(distance < radius)) return;
    // At corners edges are equally near but for rounding.
    const double off = std::round(distance / (rounding_of_snap * snap_));
    if (off < closest || (off == closest && indexed_[at(i)] < best)) {
      closest = off;
      best = indexed_[at(i)];
    }
  });
  return best;
}

void SnapGraph::insert(int e, int point) {
  const Edge& target = edge(e);
  if (point == target.a || point == target.b) return;
  if (!awaits_insert_.emplace(pair_key(e, point), true).second) return;
  inserts_.push_back({e,
                      rounded(nearest_on_segment(place(point), place(target.a), place(target.b))),
                      point, target.is_fixed});
}

// A point of a present fixed edge near p, which lies on the edge to rounding: the nearest accepted
// one that is there, or a new one, which then awaits its insertion.
template <class Accept>
int SnapGraph::point_on(int fixed_edge, const Vec2& p, const Accept& accept) {
  const Edge& e = edge(fixed_edge);
  const double rounding = roundings * p.cwiseAbs().maxCoeff();
  const int there = grid_.nearest(p, edge_share * snap_, [&](int i, double distance) {
    const bool is_on_it = i == e.a || i == e.b || awaits_insert_.contains(pair_key(fixed_edge, i));
    return (is_on_it && accept(i)) || distance <= rounding;
  });
  if (there >= 0) {
    insert(fixed_edge, there);
    return there;
  }
  const int point = new_point(p);
  insert(fixed_edge, point);
  return point;
}

// Whether a fixed edge lies between two points.
bool SnapGraph::is_hidden(const Vec2& p, const Vec2& q) {
  if (!fixed_tree_) index_fixed_edges();
  bool result = false;
  visit_overlaps(*fixed_tree_, flat_bounds(p, q), [&](int i) {
    const Edge& e = edge(indexed_[at(i)]);
    result = result || clearly_cross(p, q, place(e.a), place(e.b), rounding_of_snap * snap_);
  });
  return result;
}

// The point that stands for p: a point nearby, or one on a fixed edge nearby, or a new one. `ends`:
// of the edges that p lies on.
int SnapGraph::point_for(const Vec2& p, double merge, const std::array<int, 4>& ends) {
  const int there = grid_.nearest(p, snap_, [&](int i, double distance) {
    if (distance > merge && !is_fixed_point_[at(i)]) return false;
    return std::find(ends.begin(), ends.end(), i) != ends.end() || !is_hidden(p, place(i));
  });
  if (there >= 0) return there;
  const int fixed_edge = nearest_fixed_edge(p, edge_share * snap_);
  if (fixed_edge < 0) return new_point(p);
  const Vec2 a = place(edge(fixed_edge).a), b = place(edge(fixed_edge).b);
  return point_on(fixed_edge, a + nearest_on_segment(p, a, b) * (b - a), [](int) { return true; });
}

// Gives two crossing edges a common point.
void SnapGraph::resolve(const Pair& crossing) {
  int e = crossing[0], f = crossing[1];
  if (edge(f).is_fixed) std::swap(e, f);
  const Vec2 a = place(edge(e).a), b = place(edge(e).b);
  const Vec2 c = place(edge(f).a), d = place(edge(f).b);
  const double side_a = cross_2d(d - c, a - c), side_b = cross_2d(d - c, b - c);
  const double t = side_a == side_b ? 0.5 : std::clamp(side_a / (side_a - side_b), 0.0, 1.0);
  const Vec2 x = a + t * (b - a);
  const auto shortens_f = [&](int i) {
    const double length = (d - c).norm();
    return (place(i) - c).norm() < length && (place(i) - d).norm() < length;
  };
  const int point = edge(e).is_fixed
                        ? point_on(e, x, shortens_f)
                        : point_for(x, snap_, {edge(e).a, edge(e).b, edge(f).a, edge(f).b});
  insert(e, point);
  insert(f, point);
}

std::vector<int> SnapGraph::present() const {
  std::vector<int> result;
  for (std::size_t e = 0; e < edges_.size(); ++e)
    if (edges_[e].part_count == 0) result.push_back(static_cast<int>(e));
  return result;
}

void SnapGraph::freeze() {
  for (const int e : present()) {
    edge(e).is_fixed = true;
    is_fixed_point_[at(edge(e).a)] = is_fixed_point_[at(edge(e).b)] = true;
  }
  fixed_tree_.reset();
}

}  // namespace halfshade
