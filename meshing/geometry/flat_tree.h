#pragma once

#include "meshing/core/types.h"

#include <span>
#include <vector>

namespace halfshade {

struct Bounds {
  Vec3 low, high;

  void include(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void include(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
};

/// A binary tree of boxes over items, halved at the median of the longest axis.
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

/// Leaves hold up to `leaf_size` items.
FlatTree make_flat_tree(std::span<const Bounds> boxes, int leaf_size = 4);

/// Calls visit(item) for the items of all leaves whose box meets `box`.
template <class Visit>
void visit_overlaps(const FlatTree& tree, const Bounds& box, Visit&& visit) {
  if (tree.nodes.empty()) return;
  int stack[FlatTree::max_stack], depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const int index = stack[--depth];
    const FlatTree::Node& node = tree.nodes[static_cast<std::size_t>(index)];
    if ((node.box.low.array() > box.high.array()).any() ||
        (node.box.high.array() < box.low.array()).any())
      continue;
    if (node.right >= 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      visit(tree.items[static_cast<std::size_t>(i)]);
  }
}

/// Calls visit(item) for the items of the leaves below which `skip(node index)` never holds.
template <class Skip, class Visit>
void walk_tree(const FlatTree& tree, Skip&& skip, Visit&& visit) {
  if (tree.nodes.empty()) return;
  int stack[FlatTree::max_stack], depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const int index = stack[--depth];
    if (skip(index)) continue;
    const FlatTree::Node& node = tree.nodes[static_cast<std::size_t>(index)];
    if (node.right >= 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
    } else {
      for (int i = node.first; i < node.first + node.count; ++i)
        visit(tree.items[static_cast<std::size_t>(i)]);
    }
  }
}

}  // namespace halfshade
