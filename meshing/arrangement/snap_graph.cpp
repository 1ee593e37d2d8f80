#include "meshing/arrangement/snap_graph.h"

#include "meshing/core/planar.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/geometry/planar_signs.h"
#include "meshing/geometry/segment_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

// Of the snap distance: how close points come to fixed edges before they are put on them, ...
constexpr double edge_share = 0.5;
// ... and points to other edges before these run through them. Points are edge_share apart or more,
// and below edge_share/√2 an edge that is led through a point falls into shorter parts.
constexpr double route_share = 0.35;
// Edges this close are held against each other exactly; far above rounding.
constexpr double crossing_share = 0.01;
// Relative to coordinates: points closer to a fixed edge than this lie on it.
constexpr double roundings = 8 * 0x1p-53;
// Rounds of new crossings, and of leading edges through points. Real input settles in a few.
constexpr int most_rounds = 200, most_passes = 1000;

// An edge is led through that many points at a time, the oldest first: the same for all lines that
// run side by side, so that they soon share edges and what is left is done once for all.
constexpr std::size_t most_inserts = 8;
constexpr int none = std::numeric_limits<int>::max();

std::uint64_t pair_key(int a, int b) {
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
}

std::uint64_t cell_key(std::int64_t x, std::int64_t y) {
  return mix_bits(mix_bits(static_cast<std::uint64_t>(x)) + static_cast<std::uint64_t>(y));
}

// How far along a segment (0…1) its point nearest to p lies.
double nearest_along(const Vec2& a, const Vec2& b, const Vec2& p) {
  const Vec2 d = b - a;
  return std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
}

double distance_to(const Vec2& a, const Vec2& b, const Vec2& p) {
  return (a + nearest_along(a, b, p) * (b - a) - p).norm();
}

bool are_crossing(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) ||
      std::max(c.x(), d.x()) < std::min(a.x(), b.x()) ||
      std::max(a.y(), b.y()) < std::min(c.y(), d.y()) ||
      std::max(c.y(), d.y()) < std::min(a.y(), b.y()))
    return false;
  return orientation(a, b, c) * orientation(a, b, d) < 0 &&
         orientation(c, d, a) * orientation(c, d, b) < 0;
}

}  // namespace

SnapGraph::SnapGraph(double snap) : snap_(snap) {}

std::int64_t SnapGraph::cell(double x) const {
  return static_cast<std::int64_t>(std::floor(x / snap_));
}

int SnapGraph::new_point(const Vec2& p) {
  const int point = static_cast<int>(points_.size());
  points_.push_back(p);
  is_fixed_point_.push_back(false);
  is_fresh_point_.push_back(true);
  const auto [entry, is_first] =
      first_in_cell_.try_emplace(cell_key(cell(p.x()), cell(p.y())), point);
  next_in_cell_.push_back(is_first ? -1 : entry->second);
  entry->second = point;
  return point;
}

// The accepted point nearest to p within a radius of at most snap_, or −1.
template <class Accept>
int SnapGraph::nearest(const Vec2& p, double radius, const Accept& accept) const {
  int best = -1;
  double closest = radius;
  for (std::int64_t x = cell(p.x()) - 1; x <= cell(p.x()) + 1; ++x)
    for (std::int64_t y = cell(p.y()) - 1; y <= cell(p.y()) + 1; ++y) {
      const auto entry = first_in_cell_.find(cell_key(x, y));
      if (entry == first_in_cell_.end()) continue;
      for (int i = entry->second; i >= 0; i = next_in_cell_[at(i)]) {
        const double distance = (place(i) - p).norm();
        const bool is_nearer =
            distance < closest || (distance == closest && (best < 0 || i < best));
        if (is_nearer && accept(i, distance)) {
          closest = distance;
          best = i;
        }
      }
    }
  return best;
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
  double closest = radius;
  visit_overlaps(*fixed_tree_, flat_bounds(p, p).grown(radius), [&](int i) {
    const Edge& e = edge(indexed_[at(i)]);
    const double distance = distance_to(place(e.a), place(e.b), p);
    if (distance < closest || (distance == closest && indexed_[at(i)] < best)) {
      closest = distance;
      best = indexed_[at(i)];
    }
  });
  return best;
}

void SnapGraph::insert(int e, int point) {
  const Edge& target = edge(e);
  if (point == target.a || point == target.b) return;
  if (!awaits_insert_.emplace(pair_key(e, point), true).second) return;
  inserts_.push_back(
      {e, nearest_along(place(target.a), place(target.b), place(point)), point, target.is_fixed});
}

// A point of a present fixed edge near p, which lies on the edge to rounding: the nearest accepted
// one that is there, or a new one, which then awaits its insertion.
template <class Accept>
int SnapGraph::point_on(int fixed_edge, const Vec2& p, const Accept& accept) {
  const Edge& e = edge(fixed_edge);
  const double rounding = roundings * p.cwiseAbs().maxCoeff();
  const int there = nearest(p, edge_share * snap_, [&](int i, double distance) {
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
    result = result || are_crossing(p, q, place(e.a), place(e.b));
  });
  return result;
}

// The point that stands for p: a point nearby, or one on a fixed edge nearby, or a new one. `ends`:
// of the edges that p lies on.
int SnapGraph::point_for(const Vec2& p, double merge, const std::array<int, 4>& ends) {
  const int there = nearest(p, snap_, [&](int i, double distance) {
    if (distance > merge && !is_fixed_point_[at(i)]) return false;
    return std::find(ends.begin(), ends.end(), i) != ends.end() || !is_hidden(p, place(i));
  });
  if (there >= 0) return there;
  const int fixed_edge = nearest_fixed_edge(p, edge_share * snap_);
  if (fixed_edge < 0) return new_point(p);
  const Vec2 a = place(edge(fixed_edge).a), b = place(edge(fixed_edge).b);
  return point_on(fixed_edge, a + nearest_along(a, b, p) * (b - a), [](int) { return true; });
}

std::vector<int> SnapGraph::present() const {
  std::vector<int> result;
  for (std::size_t e = 0; e < edges_.size(); ++e)
    if (edges_[e].part_count == 0) result.push_back(static_cast<int>(e));
  return result;
}

bool SnapGraph::settle() {
  apply_inserts();
  int passes = 0;
  for (int round = 0; round < most_rounds; ++round) {
    while (lead_through_points())
      if (++passes > most_passes) return false;
    if (!split_at_crossings()) return true;
  }
  return false;
}

void SnapGraph::freeze() {
  for (const int e : present()) {
    edge(e).is_fixed = true;
    is_fixed_point_[at(edge(e).a)] = is_fixed_point_[at(edge(e).b)] = true;
  }
  fixed_tree_.reset();
}

// Leads edges through the points near them. False if there was nothing to do.
bool SnapGraph::lead_through_points() {
  std::vector<int> ids;
  std::vector<PairSegment> segments;
  for (const int e : present()) {
    if (edge(e).is_fixed) continue;
    ids.push_back(e);
    segments.push_back({place(edge(e).a), place(edge(e).b), edge(e).is_unrouted});
  }
  if (ids.empty()) return false;
  std::vector<PairPoint> points;
  for (std::size_t i = 0; i < points_.size(); ++i)
    points.push_back({points_[i], is_fresh_point_[i]});
  const double radius = route_share * snap_;
  std::vector<std::array<int, most_inserts>> near(ids.size());
  for (auto& list : near) list.fill(none);
  const auto visit = [&](int s, int p) {
    const Edge& e = edge(ids[at(s)]);
    auto& list = near[at(s)];
    if (p >= list.back() || p == e.a || p == e.b) return;
    const Vec2 d = place(e.b) - place(e.a), to_p = place(p) - place(e.a);
    const double along = to_p.dot(d), squared = d.squaredNorm();
    if (along <= 0 || along >= squared) return;
    const double off = cross_2d(d, to_p);
    if (off * off > radius * radius * squared) return;
    if (to_p.squaredNorm() >= squared || (place(p) - place(e.b)).squaredNorm() >= squared) return;
    const auto where = std::lower_bound(list.begin(), list.end(), p);
    if (*where == p || is_hidden(place(e.a) + along / squared * d, place(p))) return;
    std::move_backward(where, list.end() - 1, list.end());
    *where = p;
  };
  SegmentPairs(segments, points, radius, visit).run();
  for (std::size_t s = 0; s < ids.size(); ++s) {
    edge(ids[s]).is_unrouted = false;
    for (const int p : near[s])
      if (p != none) insert(ids[s], p);
  }
  is_fresh_point_.assign(points_.size(), false);
  return apply_inserts();
}

// Gives crossing edges common points. False if there were no crossings.
bool SnapGraph::split_at_crossings() {
  const std::vector<int> ids = present();
  std::vector<PairSegment> segments;
  for (const int e : ids)
    segments.push_back({place(edge(e).a), place(edge(e).b), edge(e).is_uncrossed});
  std::vector<Pair> crossings;
  const auto visit = [&](int i, int j) {
    const Edge &e = edge(ids[at(i)]), &f = edge(ids[at(j)]);
    if ((e.is_fixed && f.is_fixed) || e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b) return;
    if (!are_crossing(place(e.a), place(e.b), place(f.a), place(f.b))) return;
    crossings.push_back({std::min(ids[at(i)], ids[at(j)]), std::max(ids[at(i)], ids[at(j)])});
  };
  SegmentPairs(segments, {}, crossing_share * snap_, visit).run();
  std::sort(crossings.begin(), crossings.end());
  crossings.erase(std::unique(crossings.begin(), crossings.end()), crossings.end());
  for (const int e : ids) edge(e).is_uncrossed = false;
  for (const Pair& crossing : crossings) resolve(crossing);
  apply_inserts();
  return !crossings.empty();
}

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

// Replaces edges by chains through the points found for them. False if no edge changed.
bool SnapGraph::apply_inserts() {
  std::sort(inserts_.begin(), inserts_.end());
  bool has_changed = false;
  for (std::size_t i = 0, j = 0; i < inserts_.size(); i = j) {
    const int id = inserts_[i].edge;
    const Edge whole = edge(id);
    const double length = distance(whole.a, whole.b);
    std::vector<int> chain = {whole.a};
    for (j = i; j < inserts_.size() && inserts_[j].edge == id; ++j) {
      const int p = inserts_[j].point;
      if (whole.is_fixed && !inserts_[j].is_for_fixed) continue;  // it has just become fixed
      if (whole.is_fixed || (distance(chain.back(), p) < length && distance(p, whole.b) < length))
        chain.push_back(p);
    }
    if (chain.size() == 1) continue;
    chain.push_back(whole.b);
    has_changed = true;
    if (whole.is_fixed) fixed_tree_.reset();
    std::vector<int> parts;
    for (std::size_t k = 1; k < chain.size(); ++k)
      parts.push_back(add_edge(chain[k - 1], chain[k], whole.is_fixed));
    edge(id).first_part = static_cast<int>(parts_.size());
    edge(id).part_count = static_cast<int>(parts.size());
    parts_.insert(parts_.end(), parts.begin(), parts.end());
  }
  inserts_.clear();
  awaits_insert_.clear();
  return has_changed;
}

}  // namespace halfshade
