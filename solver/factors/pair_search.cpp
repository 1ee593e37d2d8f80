#include "solver/factors/pair_search.h"

#include "meshing/core/parallel.h"
#include "solver/factors/one_blocker.h"

#include <algorithm>
#include <array>
#include <utility>

namespace halfshade {
namespace {

/// Some of the parts of a joined surface, and a rectangle that holds them.
struct Group {
  int first, last;              ///< range of GroupTree::parts
  int low = -1;                 ///< of its halves, the other one comes next; −1: one part alone
  Polygon3 rectangle;           ///< counter-clockwise
  std::vector<int> cells = {};  ///< of space that any part is in, rising
};

/// Halves of halves of a joined surface; the first group is all of it.
struct GroupTree {
  std::vector<int> parts;
  std::vector<Group> groups;
};

class TreeMaker {
 public:
  TreeMaker(const SightScene& scene, const std::vector<int>& parts) : scene_(scene) {
    tree_.parts = parts;
    tree_.groups.push_back({0, static_cast<int>(parts.size()), -1, {}});
    for (std::size_t g = 0; g < tree_.groups.size(); ++g) fill(g);
  }

  GroupTree tree_;

 private:
  void fill(std::size_t g) {
    const PlaneFrame& frame = scene_.surfaces[at(tree_.parts.front())].frame;
    const int first = tree_.groups[g].first, last = tree_.groups[g].last;
    Eigen::AlignedBox2d box;
    std::vector<int>& cells = tree_.groups[g].cells;
    for (int k = first; k < last; ++k) {
      const SightSurface& part = scene_.surfaces[at(tree_.parts[at(k)])];
      for (const Vec3& p : part.outline) box.extend(frame.to_plane(p));
      cells.insert(cells.end(), part.cells.begin(), part.cells.end());
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    const Vec2 low = box.min(), high = box.max();
    for (const Vec2& p : {low, Vec2(high.x(), low.y()), high, Vec2(low.x(), high.y())})
      tree_.groups[g].rectangle.push_back(frame.to_space(p));
    if (last - first < 2) return;
    const Vec3& along = box.sizes().x() > box.sizes().y() ? frame.e1 : frame.e2;
    const auto place = [&](int part) {
      const Polygon3& outline = scene_.surfaces[at(part)].outline;
      double least = HUGE_VAL, most = -HUGE_VAL;
      for (const Vec3& p : outline) {
        least = std::min(least, along.dot(p - frame.origin));
        most = std::max(most, along.dot(p - frame.origin));
      }
      return std::pair(least + most, part);
    };
    const int middle = (first + last) / 2;
    std::nth_element(tree_.parts.begin() + first, tree_.parts.begin() + middle,
                     tree_.parts.begin() + last, [&](int a, int b) { return place(a) < place(b); });
    tree_.groups[g].low = static_cast<int>(tree_.groups.size());
    tree_.groups.push_back({first, middle, -1, {}});
    tree_.groups.push_back({middle, last, -1, {}});
  }

  const SightScene& scene_;
};

/// So many sides of a body are looked at together first.
constexpr std::size_t worth_a_shaft = 8;

class PairSearch {
 public:
  PairSearch(const FactorScene& rows, const SightScene& scene) : rows_(rows), scene_(scene) {
    for (const std::vector<int>& parts : scene.joined.parts)
      trees_.push_back(TreeMaker(scene, parts).tree_);
    sides_.resize(scene.bodies.size());
    for (std::size_t t = 0; t < trees_.size(); ++t)
      if (scene.body_of[t] >= 0) sides_[at(scene.body_of[t])].push_back(static_cast<int>(t));
    for (std::vector<int>& sides : sides_)
      if (sides.size() < worth_a_shaft) sides.clear();
  }

  struct Found {
    int a;
    SightPair pair;
  };

  void search(int a, std::vector<Found>& found) const {
    for (int b = a + 1; b < static_cast<int>(trees_.size()); ++b)
      if (!is_of_large_body(b)) search(a, b, nullptr, found);
    for (std::size_t body = 0; body < sides_.size(); ++body) search_body(a, body, found);
  }

 private:
  struct Node {
    int tree, group;
  };

  bool is_of_large_body(int tree) const {
    const int body = scene_.body_of[at(tree)];
    return body >= 0 && !sides_[at(body)].empty();
  }

  void search(int a, int b, const Between* known, std::vector<Found>& found) const {
    const auto& planes = scene_.joined.sound.surfaces;
    if (planes[at(a)].plane != planes[at(b)].plane && (has_rows(a) || has_rows(b)))
      visit({a, 0}, {b, 0}, known, found);
  }

  /// What lies between a surface and all of a body holds what lies between it and any side.
  void search_body(int a, std::size_t body, std::vector<Found>& found) const {
    const auto first = std::upper_bound(sides_[body].begin(), sides_[body].end(), a);
    const int own = scene_.body_of[at(a)];
    if (first == sides_[body].end() || own == static_cast<int>(body)) return;
    const Polygon3& part = shape({a, 0});
    const ConvexBody& other = scene_.bodies[body];
    Between between = scene_.between.candidates(part, box_round(other));
    // Sides of the two hide nothing of each other: they are convex. Nor does what lies in the
    // plane.
    const int plane = scene_.joined.sound.surfaces[at(a)].plane;
    std::erase_if(between, [&](int t) {
      const int of = scene_.blockers[at(scene_.blocker_of[at(t)])].body;
      const bool is_side = of >= 0 && (of == own || of == static_cast<int>(body));
      return is_side || scene_.between.soup().plane[at(t)] == plane;
    });
    if (hides_all(scene_, between, part, other.vertices)) return;
    for (auto b = first; b != sides_[body].end(); ++b) search(a, *b, &between, found);
  }

  /// The corners of a box, along edges of it.
  static Polygon3 box_round(const ConvexBody& body) {
    const Vec3 &low = body.low, &high = body.high;
    return {low,
            {high.x(), low.y(), low.z()},
            {high.x(), high.y(), low.z()},
            {low.x(), high.y(), low.z()},
            {low.x(), high.y(), high.z()},
            high,
            {high.x(), low.y(), high.z()},
            {low.x(), low.y(), high.z()}};
  }

  const Group& group(const Node& n) const { return trees_[at(n.tree)].groups[at(n.group)]; }
  std::span<const int> parts(const Node& n) const {
    const Group& g = group(n);
    return {trees_[at(n.tree)].parts.data() + g.first, at(g.last - g.first)};
  }
  bool has_rows(int tree) const {
    return std::any_of(trees_[at(tree)].parts.begin(), trees_[at(tree)].parts.end(),
                       [&](int s) { return rows_.row[at(s)] >= 0; });
  }

  /// `known` are the triangles that reach between what the two are parts of.
  void visit(const Node& m, const Node& n, const Between* known, std::vector<Found>& found) const {
    const int a = parts(m).front(), b = parts(n).front();
    const bool is_pair = group(m).low < 0 && group(n).low < 0;
    if (!share_a_cell(group(m), group(n))) return;
    Between own;  // stays empty where more than two convex polygons are looked at
    const Sight sight = is_pair && (!known || !is_convex(a) || !is_convex(b))
                            ? sight_between(scene_, a, b)
                            : sight_between_convex(scene_, shape(m), a, shape(n), b, known, own);
    if (sight == Sight::none) return;
    if (is_pair || sight == Sight::clear) return add(m, n, sight, own, found);
    const bool cuts_first = group(n).low < 0 || (group(m).low >= 0 && size(m) >= size(n));
    const int low = group(cuts_first ? m : n).low;
    for (const int half : {low, low + 1})
      cuts_first ? visit({m.tree, half}, n, &own, found) : visit(m, {n.tree, half}, &own, found);
  }

  static bool share_a_cell(const Group& a, const Group& b) {
    return std::any_of(a.cells.begin(), a.cells.end(), [&](int cell) {
      return std::binary_search(b.cells.begin(), b.cells.end(), cell);
    });
  }

  bool is_convex(int s) const { return scene_.surfaces[at(s)].pieces.size() == 1; }

  /// A convex polygon that holds a group.
  const Polygon3& shape(const Node& n) const {
    const int part = parts(n).front();
    return group(n).low < 0 && is_convex(part) ? scene_.surfaces[at(part)].pieces.front()
                                               : group(n).rectangle;
  }

  double size(const Node& n) const {
    const Polygon3& r = group(n).rectangle;
    return (r[2] - r[0]).squaredNorm();
  }

  void add(const Node& m, const Node& n, Sight sight, const Between& between,
           std::vector<Found>& found) const {
    std::vector<int> blockers;
    for (const int t : between) blockers.push_back(scene_.blocker_of[at(t)]);
    std::sort(blockers.begin(), blockers.end());
    blockers.erase(std::unique(blockers.begin(), blockers.end()), blockers.end());
    for (const int a : parts(m))
      for (const int b : parts(n)) {
        const bool has_a = rows_.row[at(a)] >= 0, has_b = rows_.row[at(b)] >= 0;
        if (!(has_a || has_b) || !may_see(scene_, a, b)) continue;
        const bool is_first = has_a && (a < b || !has_b);
        SightPair pair{is_first ? b : a, sight, {}};
        pair.is_in_cells = sight == Sight::partial && is_clear_in_cells(scene_, a, b);
        if (pair.is_in_cells)
          pair.sight = Sight::clear;
        else
          pair.blockers = blockers;
        found.push_back({is_first ? a : b, std::move(pair)});
      }
  }

  const FactorScene& rows_;
  const SightScene& scene_;
  std::vector<GroupTree> trees_;         // by joined surface
  std::vector<std::vector<int>> sides_;  // of bodies with many, joined surfaces, rising
};

}  // namespace

std::vector<std::vector<SightPair>> find_pairs(const FactorScene& scene, const SightScene& sight,
                                               const Progress& progress) {
  const PairSearch search(scene, sight);
  std::vector<std::vector<PairSearch::Found>> found(sight.joined.parts.size());
  parallel_for(
      found.size(), [&](std::size_t j) { search.search(static_cast<int>(j), found[j]); }, progress,
      "what surfaces see of each other");
  std::vector<std::vector<SightPair>> pairs(sight.surfaces.size());
  for (auto& some : found) {
    for (auto& [a, pair] : some) pairs[at(a)].push_back(std::move(pair));
    some = {};
  }
  for (auto& some : pairs)
    std::sort(some.begin(), some.end(),
              [](const SightPair& a, const SightPair& b) { return a.other < b.other; });
  return pairs;
}

}  // namespace halfshade
