#pragma once

#include "meshing/core/types.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace halfshade {

using Box = Eigen::AlignedBox3d;

/// A binary tree of axis-aligned boxes over fixed items, for "which items can touch this?".
/// Deterministic; O(n log n) to build.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
    std::iota(items_.begin(), items_.end(), 0);
    if (!items_.empty()) build(0, items_.size());
  }

  /// Calls `visit(item)` for every item whose box `reaches`, a predicate that is true of a box
  /// whenever it is true of a part of it. Order unspecified, but always the same.
  template <class Reaches, class Visit>
  void query(const Reaches& reaches, const Visit& visit) const {
    std::vector<int> open;
    if (!nodes_.empty()) open.push_back(0);
    while (!open.empty()) {
      const Node& node = nodes_[static_cast<std::size_t>(open.back())];
      open.pop_back();
      if (!reaches(node.box)) continue;
      if (node.left >= 0) {
        open.push_back(node.right);
        open.push_back(node.left);
        continue;
      }
      for (std::size_t k = node.begin; k < node.end; ++k)
        if (reaches(boxes_[static_cast<std::size_t>(items_[k])])) visit(items_[k]);
    }
  }

  /// Calls `visit(item)` for every item whose box touches `box`.
  template <class Visit>
  void query_box(const Box& box, const Visit& visit) const {
    query([&](const Box& other) { return other.intersects(box); }, visit);
  }

 private:
  struct Node {
    Box box;
    std::size_t begin = 0, end = 0;  // of items_
    int left = -1, right = -1;       // −1: a leaf
  };
  static constexpr std::size_t leaf_size = 4;

  int build(std::size_t begin, std::size_t end) {
    const int index = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    Box box, centres;
    for (std::size_t k = begin; k < end; ++k) {
      box.extend(boxes_[static_cast<std::size_t>(items_[k])]);
      centres.extend(boxes_[static_cast<std::size_t>(items_[k])].center());
    }
    int left = -1, right = -1;
    if (end - begin > leaf_size) {
      int axis = 0;
      centres.sizes().maxCoeff(&axis);
      const std::size_t middle = begin + (end - begin) / 2;
      const auto at = [&](std::size_t k) {
        return items_.begin() + static_cast<std::ptrdiff_t>(k);
      };
      std::nth_element(at(begin), at(middle), at(end), [&](int a, int b) {
        const double ca = boxes_[static_cast<std::size_t>(a)].center()[axis];
        const double cb = boxes_[static_cast<std::size_t>(b)].center()[axis];
        return std::pair(ca, a) < std::pair(cb, b);
      });
      left = build(begin, middle);
      right = build(middle, end);
    }
    nodes_[static_cast<std::size_t>(index)] = {box, begin, end, left, right};
    return index;
  }

  std::vector<Box> boxes_;
  std::vector<int> items_;
  std::vector<Node> nodes_;
};

}  // namespace halfshade
