#include "meshing/arrangement/arrangement.h"

#include "meshing/core/planar.h"
#include "meshing/geometry/flat_tree.h"

#include <cmath>
#include <map>
#include <optional>

namespace halfshade {
namespace {

// Every round splits links into strictly shorter ones; real input settles in two or three.
constexpr int most_rounds = 40;

using Link = std::array<int, 2>;  // sorted
using Inserts = std::map<Link, std::vector<int>>;

Link sorted(int a, int b) { return a < b ? Link{a, b} : Link{b, a}; }

// For each point the first point within `snap` of it.
std::vector<int> first_of_each_place(std::span<const Vec2> points, double snap) {
  std::vector<Bounds> boxes;
  boxes.reserve(points.size());
  for (const Vec2& p : points) boxes.push_back(flat_bounds(p, p));
  const FlatTree tree = make_flat_tree(boxes, 1);
  std::vector<int> first(points.size());
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    first[at(i)] = i;
    visit_overlaps(tree, flat_bounds(points[at(i)], points[at(i)]).grown(snap), [&](int j) {
      const bool settled = j < i && first[at(j)] == j;
      if (settled && (points[at(j)] - points[at(i)]).norm() <= snap)
        first[at(i)] = std::min(first[at(i)], j);
    });
  }
  return first;
}

class Arranger {
 public:
  Arranger(std::vector<Vec2> points, std::span<const std::array<int, 2>> segments,
           const SnapRadii& snap)
      : points_(std::move(points)), snap_(snap) {
    const std::vector<int> first = first_of_each_place(points_, snap_.points);
    for (const auto& [a, b] : segments) {
      chains_.push_back({first[at(a)]});
      if (first[at(a)] != first[at(b)]) chains_.back().push_back(first[at(b)]);
    }
  }

  Arrangement run() {
    for (int round = 0; round < most_rounds; ++round) {
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
        links_.push_back(sorted(chain[k - 1], chain[k]));
    std::sort(links_.begin(), links_.end());
    links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
  }

  Bounds box_of(const Link& link) const {
    return flat_bounds(points_[at(link[0])], points_[at(link[1])]);
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
    std::vector<Bounds> boxes;
    for (const int p : used) boxes.push_back(flat_bounds(points_[at(p)], points_[at(p)]));
    const FlatTree tree = make_flat_tree(boxes, 1);
    Inserts inserts;
    std::vector<std::pair<double, int>> found;
    for (const Link& link : links_) {
      found.clear();
      visit_overlaps(tree, box_of(link).grown(snap_.links), [&](int k) {
        if (const auto t = reach(link, used[at(k)])) found.emplace_back(*t, used[at(k)]);
      });
      std::sort(found.begin(), found.end());
      for (const auto& [t, p] : found) inserts[link].push_back(p);
    }
    return inserts;
  }

  Inserts crossings() {
    std::vector<Bounds> boxes;
    for (const Link& link : links_) boxes.push_back(box_of(link));
    const FlatTree tree = make_flat_tree(boxes, 1);
    std::map<Link, std::vector<std::pair<double, int>>> found;
    for (int i = 0; i < static_cast<int>(links_.size()); ++i) {
      std::vector<int> others;
      visit_overlaps(tree, boxes[at(i)], [&](int j) {
        if (j > i) others.push_back(j);
      });
      std::sort(others.begin(), others.end());
      for (const int j : others) cross_links(links_[at(i)], links_[at(j)], found);
    }
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
    const auto cell = [&](double v) {
      return static_cast<long long>(std::floor(v / snap_.points / 2));
    };
    for (long long i = -1; i <= 1; ++i)
      for (long long j = -1; j <= 1; ++j) {
        const auto entry = crossings_.find({cell(x.x()) + i, cell(x.y()) + j});
        if (entry == crossings_.end()) continue;
        for (const int p : entry->second)
          if ((points_[at(p)] - x).norm() <= snap_.points) return p;
      }
    points_.push_back(x);
    const int point = static_cast<int>(points_.size()) - 1;
    crossings_[{cell(x.x()), cell(x.y())}].push_back(point);
    return point;
  }

  void apply(const Inserts& inserts) {
    for (auto& chain : chains_) {
      std::vector<int> longer = {chain[0]};
      for (std::size_t k = 1; k < chain.size(); ++k) {
        const auto between = inserts.find(sorted(chain[k - 1], chain[k]));
        if (between != inserts.end()) {
          const auto& p = between->second;
          if (chain[k - 1] < chain[k])
            longer.insert(longer.end(), p.begin(), p.end());
          else
            longer.insert(longer.end(), p.rbegin(), p.rend());
        }
        longer.push_back(chain[k]);
      }
      chain = std::move(longer);
    }
  }

  std::vector<Vec2> points_;
  SnapRadii snap_;
  std::vector<std::vector<int>> chains_;
  std::vector<Link> links_;
  std::map<std::pair<long long, long long>, std::vector<int>> crossings_;  // by place
};

}  // namespace

Arrangement arrange(std::vector<Vec2> points, std::span<const std::array<int, 2>> segments,
                    const SnapRadii& snap) {
  return Arranger(std::move(points), segments, snap).run();
}

}  // namespace halfshade
