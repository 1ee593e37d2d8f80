#pragma once

#include "meshing/core/types.h"

#include <limits>
#include <span>
#include <vector>

namespace halfshade {

/// A closed box with sides along the axes; empty to begin with.
struct Bounds {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void include(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void include(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  Bounds grown(double margin) const {
    return {low - Vec3::Constant(margin), high + Vec3::Constant(margin)};
  }
  bool meets(const Bounds& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  Vec3 centre() const { return 0.5 * (low + high); }
  Vec3 half_size() const { return 0.5 * (high - low); }
};

/// The box of a segment.
inline Bounds bounds_of(const Vec3& a, const Vec3& b) { return {a.cwiseMin(b), a.cwiseMax(b)}; }

/// The box of a segment of a plane, as that of z = 0.
inline Bounds flat_bounds(const Vec2& a, const Vec2& b) {
  const Vec2 low = a.cwiseMin(b), high = a.cwiseMax(b);
  return {{low.x(), low.y(), 0}, {high.x(), high.y(), 0}};
}

/// A binary tree of boxes over items, for "which items can touch this?".
struct FlatTree {
  struct Node {
    Bounds box;
    int right = -1;            ///< the left child follows its parent; −1 in leaves
    int first = 0, count = 0;  ///< all items below, a range of `items`
  };
  /// Enough for a depth-first walk: halving keeps the depth below 40.
  static constexpr int max_stack = 64;

  std::vector<Node> nodes;  ///< depth first; empty if there are no items
  std::vector<int> items;
};

/// Halves the items at the median of the longest axis until `leaf_size` or fewer are left. Leaves
/// of several items make a walk quicker that has its own test of items; with one item to a leaf,
/// the queries below visit no item but those whose own box passes. O(n log n); deterministic.
FlatTree make_flat_tree(std::span<const Bounds> boxes, int leaf_size = 4);

/// The same for trees that are asked often: of the divisions along the three axes that leave either
/// side a quarter, the one whose boxes are the least likely to be met by a ray, which have the
/// least surface for their items (Goldsmith & Salmon 1987). Ranges of many thousands are halved.
/// Rays pass a third fewer boxes in furnished rooms, half as many in the dining room of data/; it
/// takes several times as long to make, O(n log² n).
FlatTree make_tight_tree(std::span<const Bounds> boxes, int leaf_size = 4);

/// Walks from the root downwards, left children first. `skip(node index, state)` says whether
/// nothing below a node matters, and may change the state for what is below; the items of leaves
/// that are left go to `visit(item, state)`.
template <class State, class Skip, class Visit>
void walk_tree(const FlatTree& tree, const State& start, Skip&& skip, Visit&& visit) {
  if (tree.nodes.empty()) return;
  struct Open {
    int node;
    [[no_unique_address]] State state;
  };
  Open stack[FlatTree::max_stack];
  int depth = 0;
  stack[depth++] = {0, start};
  while (depth > 0) {
    auto [index, state] = stack[--depth];
    if (skip(index, state)) continue;
    const FlatTree::Node& node = tree.nodes[at(index)];
    if (node.right >= 0) {
      stack[depth++] = {node.right, state};
      stack[depth++] = {index + 1, state};
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) visit(tree.items[at(i)], state);
  }
}

/// Calls visit(item) for the items of the leaves below which `skip(node index)` never holds.
template <class Skip, class Visit>
void walk_tree(const FlatTree& tree, Skip&& skip, Visit&& visit) {
  struct Nothing {};
  walk_tree(
      tree, Nothing{}, [&](int index, Nothing) { return skip(index); },
      [&](int item, Nothing) { visit(item); });
}

/// Calls visit(item) for the items of all leaves whose box `reaches`, a predicate that is true of a
/// box whenever it is true of a part of it. Order unspecified, but always the same.
template <class Reaches, class Visit>
void visit_reached(const FlatTree& tree, Reaches&& reaches, Visit&& visit) {
  walk_tree(
      tree, [&](int index) { return !reaches(tree.nodes[at(index)].box); }, visit);
}

/// Calls visit(item) for the items of all leaves whose box meets `box`.
template <class Visit>
void visit_overlaps(const FlatTree& tree, const Bounds& box, Visit&& visit) {
  visit_reached(
      tree, [&](const Bounds& other) { return box.meets(other); }, visit);
}

}  // namespace halfshade
