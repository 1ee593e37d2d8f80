#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

/// Centres closer than this share of a node's size have the order of their numbers.
constexpr double equal = 0x1p-30;

int add_node(FlatTree& tree, std::span<const Bounds> boxes, int first, int count, int leaf_size) {
  const auto begin = tree.items.begin() + first, end = begin + count;
  FlatTree::Node node;
  node.first = first;
  node.count = count;
  Bounds centres;
  for (auto item = begin; item != end; ++item) {
    node.box.include(boxes[at(*item)]);
    centres.include(boxes[at(*item)].centre());
  }
  const auto index = static_cast<int>(tree.nodes.size());
  tree.nodes.push_back(node);
  if (count <= leaf_size) return index;
  const Vec3 size = centres.high - centres.low;
  int axis = 0;  // the first of the longest; ties are not for rounding to break
  for (int k = 1; k < 3; ++k)
    if (size[k] > size[axis] * (1 + equal)) axis = k;
  const double unit = size[axis] > 0 ? equal * size[axis] : 1;
  const int half = count / 2;
  std::nth_element(begin, begin + half, end, [&](int i, int j) {
    const double x = std::round((boxes[at(i)].centre()[axis] - centres.low[axis]) / unit);
    const double y = std::round((boxes[at(j)].centre()[axis] - centres.low[axis]) / unit);
    return x != y ? x < y : i < j;
  });
  add_node(tree, boxes, first, half, leaf_size);
  const int right = add_node(tree, boxes, first + half, count - half, leaf_size);
  tree.nodes[at(index)].right = right;
  return index;
}

}  // namespace

FlatTree make_flat_tree(std::span<const Bounds> boxes, int leaf_size) {
  FlatTree tree;
  tree.items.resize(boxes.size());
  std::iota(tree.items.begin(), tree.items.end(), 0);
  if (!boxes.empty()) add_node(tree, boxes, 0, static_cast<int>(boxes.size()), leaf_size);
  return tree;
}

}  // namespace halfshade
