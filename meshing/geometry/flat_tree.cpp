#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <numeric>

namespace halfshade {
namespace {

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
  int axis = 0;
  (centres.high - centres.low).maxCoeff(&axis);
  const int half = count / 2;
  std::nth_element(begin, begin + half, end, [&](int i, int j) {
    const double x = boxes[at(i)].centre()[axis], y = boxes[at(j)].centre()[axis];
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
