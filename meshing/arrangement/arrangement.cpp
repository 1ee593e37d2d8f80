#include "meshing/arrangement/arrangement.h"

#include "meshing/arrangement/point_grid.h"
#include "meshing/core/planar.h"
#include "meshing/geometry/segment_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace halfshade {
namespace {

// Every round splits links into strictly shorter ones; real input settles in two or three.
constexpr int most_snap_rounds = 40;

using Inserts = std::map<Link, std::vector<int>>;

// For each point the first point within `snap` of it.
std::vector<int> first_of_each_place(std::span<const Vec2> points, double snap) {
  PointGrid places(snap);
  std::vector<int> first(points.size());
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    first[at(i)] = i;
    places.for_each_near(points[at(i)], snap,
                         [&](int j, double) { first[at(i)] = std::min(first[at(i)], j); });
    if (first[at(i)] == i) places.add(i, points[at(i)]);
  }
  return first;
}

// Among points nearer to each other than links snap, a chain may turn back, and would double in
// every round. What it runs to and fro in lies within the radius and is left out.
std::vector<int> without_loops(const std::vector<int>& chain) {
  std::vector<int> result;
  for (const int p : chain) {
    const auto known = std::find(result.begin(), result.end(), p);
    if (known == result.end())
      result.push_back(p);
    else
      result.erase(known + 1, result.end());
  }
  return result;
}

class Arranger {
 public:
  Arranger(std::vector<Vec2> points, std::span<const std::array<int, 2>> segments,
           const SnapRadii& snap)
      : points_(std::move(points)), snap_(snap), crossings_(snap.points) {
    const std::vector<int> first = first_of_each_place(points_, snap_.points);
    for (const auto& [a, b] : segments) {
      chains_.push_back({first[at(a)]});
      if (first[at(a)] != first[at(b)]) chains_.back().push_back(first[at(b)]);
    }
  }

  Arrangement run() {
    for (int round = 0; round < most_snap_rounds; ++round) {
      collect_links();
      Inserts inserts = points_on_links();
      if (inserts.empty()) inserts = crossings();
      if (inserts.empty()) break;
      apply(inserts);
    }
    return {std::move(points_), std::move(chains_)};
  }

 private:
  void collect_links() {
    links_.clear();
    for (const auto& chain : chains_)
      for (std::size_t k = 1; k < chain.size(); ++k)
        links_.push_back(sorted_link(chain[k - 1], chain[k]));
    std::sort(links_.begin(), links_.end());
    links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
  }

  Eigen::AlignedBox2d box_of(const Link& link) const {
    return Eigen::AlignedBox2d(points_[at(link[0])]).extend(points_[at(link[1])]);
  }

  std::vector<PairSegment> pair_segments() const {
    std::vector<PairSegment> segments;
    for (const auto& [a, b] : links_) segments.push_back({points_[at(a)], points_[at(b)]});
    return segments;
  }

  // How far along the link (0…1) a point lies that the link has to run through.
  std::optional<double> reach(const Link& link, int point) const {
    if (point == link[0] || point == link[1]) return {};
    const Vec2 &a = points_[at(link[0])], &b = points_[at(link[1])], &p = points_[at(point)];
    const double length = (b - a).norm();
    if (std::abs(cross_2d(b - a, p - a)) > snap_.links * length) return {};
    // Both parts must come out shorter, or splitting might go on without end.
    if (!((p - a).norm() < length && (p - b).norm() < length)) return {};
    const double t = (p - a).dot(b - a) / (length * length);
    if (!(t > 0 && t < 1)) return {};
    return t;
  }

  Inserts points_on_links() const {
    std::vector<int> used;
    for (const Link& link : links_) used.insert(used.end(), link.begin(), link.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    std::vector<PairPoint> points;
    for (const int p : used) points.push_back({points_[at(p)]});
    std::vector<std::tuple<int, double, int>> found;  // link, how far along, point
    const auto visit = [&](int l, int k) {
      if (const auto t = reach(links_[at(l)], used[at(k)])) found.emplace_back(l, *t, used[at(k)]);
    };
    SegmentPairs(pair_segments(), points, snap_.links, visit).run();
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    Inserts inserts;
    for (const auto& [l, t, p] : found) inserts[links_[at(l)]].push_back(p);
    return inserts;
  }

  Inserts crossings() {
    std::vector<std::array<int, 2>> pairs;
    const auto visit = [&](int i, int j) {
      // Parts of one line are told from crossings by their boxes, not by signs of zero.
      if (box_of(links_[at(i)]).intersects(box_of(links_[at(j)])))
        pairs.push_back(sorted_link(i, j));
    };
    SegmentPairs(pair_segments(), {}, snap_.links, visit).run();
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    std::map<Link, std::vector<std::pair<double, int>>> found;
    for (const auto& [i, j] : pairs) cross_links(links_[at(i)], links_[at(j)], found);
    Inserts inserts;
    for (auto& [link, along] : found) {
      std::sort(along.begin(), along.end());
      for (const auto& [t, p] : along)
        if (inserts[link].empty() || inserts[link].back() != p) inserts[link].push_back(p);
    }
    return inserts;
  }

  void cross_links(const Link& m, const Link& n,
                   std::map<Link, std::vector<std::pair<double, int>>>& found) {
    if (m[0] == n[0] || m[0] == n[1] || m[1] == n[0] || m[1] == n[1]) return;
    const Vec2 a = points_[at(m[0])], b = points_[at(m[1])];
    const Vec2 c = points_[at(n[0])], d = points_[at(n[1])];
    const double side_c = cross_2d(b - a, c - a), side_d = cross_2d(b - a, d - a);
    const double side_a = cross_2d(d - c, a - c), side_b = cross_2d(d - c, b - c);
    if ((side_c > 0) == (side_d > 0) || (side_a > 0) == (side_b > 0)) return;
    const double t = side_a / (side_a - side_b), s = side_c / (side_c - side_d);
    const Vec2 x = a + t * (b - a);
    const int point = point_at(x, m, n);
    if (point != m[0] && point != m[1]) found[m].emplace_back(t, point);
    if (point != n[0] && point != n[1]) found[n].emplace_back(s, point);
  }

  // A crossing that falls on an end of either link or on an earlier crossing takes that point.
  int point_at(const Vec2& x, const Link& m, const Link& n) {
    for (const int p : {m[0], m[1], n[0], n[1]})
      if ((points_[at(p)] - x).norm() <= snap_.links) return p;
    const int there = crossings_.nearest(x, snap_.points, [](int, double) { return true; });
    if (there >= 0) return there;
    points_.push_back(x);
    const int point = static_cast<int>(points_.size()) - 1;
    crossings_.add(point, x);
    return point;
  }

  void apply(const Inserts& inserts) {
    for (auto& chain : chains_) {
      std::vector<int> longer = {chain[0]};
      for (std::size_t k = 1; k < chain.size(); ++k) {
        const auto between = inserts.find(sorted_link(chain[k - 1], chain[k]));
        if (between != inserts.end()) {
          const auto& p = between->second;
          if (chain[k - 1] < chain[k])
            longer.insert(longer.end(), p.begin(), p.end());
          else
            longer.insert(longer.end(), p.rbegin(), p.rend());
        }
        longer.push_back(chain[k]);
      }
      if (longer.size() > chain.size()) chain = without_loops(longer);
    }
  }

  std::vector<Vec2> points_;
  SnapRadii snap_;
  std::vector<std::vector<int>> chains_;
  std::vector<Link> links_;
  PointGrid crossings_;
};

}  // namespace

Arrangement arrange(std::vector<Vec2> points, std::span<const std::array<int, 2>> segments,
                    const SnapRadii& snap) {
  return Arranger(std::move(points), segments, snap).run();
}

}  // namespace halfshade
