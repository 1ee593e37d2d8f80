#include "meshing/arrangement/snap_graph.h"
#include "meshing/core/planar.h"
#include "meshing/geometry/planar_signs.h"
#include "meshing/geometry/segment_pairs.h"

#include <algorithm>
#include <limits>

// Settling: edges are led through points near them and split where they cross, until there is
// nothing left to do.

namespace halfshade {
namespace {

// Of the snap distance: how close points come to edges before these run through them. Points are
// half of it apart or more, and below ½/√2 an edge that is led through a point falls into shorter
// parts.
constexpr double route_share = 0.35;
// Likewise: edges this close are held against each other exactly; far above rounding.
constexpr double crossing_share = 0.01;
// Rounds of new crossings, and of leading edges through points. Real input settles in a few.
constexpr int most_rounds = 200, most_passes = 1000;

// An edge is led through that many points at a time, the oldest first: the same for all lines that
// run side by side, so that they soon share edges and what is left is done once for all.
constexpr std::size_t most_inserts = 8;
constexpr int none = std::numeric_limits<int>::max();

}  // namespace

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
