#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// Centres closer than this share of a node's size have the order of their numbers.
constexpr double equal = 0x1p-30;
/// Surfaces that differ by less are the same.
constexpr double clearly_less = 1e-9;
/// Longer ranges are halved, for their boxes overlap little and each would be sorted three times.
/// A quarter on either side of these keeps walks within FlatTree::max_stack.
constexpr std::size_t most_swept = 4096;

/// The place of an item's centre along an axis: those that differ by rounding have the same.
class PlaceAlong {
 public:
  PlaceAlong(std::span<const Bounds> boxes, const Bounds& centres, int axis)
      : boxes_(boxes), axis_(axis), low_(centres.low[axis]) {
    const double size = centres.high[axis] - low_;
    if (size > 0) unit_ = equal * size;
  }
  double operator()(int item) const {
    return std::round((boxes_[at(item)].centre()[axis_] - low_) / unit_);
  }

 private:
  std::span<const Bounds> boxes_;
  int axis_;
  double low_, unit_ = 1;
};

/// Half of them to the left along the longest axis. The number of those. Allocates nothing: trees
/// over the points of a batch are made all the time.
int halve_items(std::span<const Bounds> boxes, const Bounds& centres, std::span<int> items) {
  const Vec3 size = centres.high - centres.low;
  int axis = 0;  // the first of the longest; ties are not for rounding to break
  for (int k = 1; k < 3; ++k)
    if (size[k] > size[axis] * (1 + equal)) axis = k;
  const PlaceAlong place(boxes, centres, axis);
  const auto half = static_cast<std::ptrdiff_t>(items.size() / 2);
  std::nth_element(items.begin(), items.begin() + half, items.end(), [&](int i, int j) {
    const double x = place(i), y = place(j);
    return x != y ? x < y : i < j;
  });
  return static_cast<int>(half);
}

/// Items with their places along an axis, in that order; where these are the same, by number.
std::vector<std::pair<double, int>> in_order(std::span<const Bounds> boxes, const Bounds& centres,
                                             std::span<const int> items, int axis) {
  const PlaceAlong place(boxes, centres, axis);
  std::vector<std::pair<double, int>> order;
  for (const int i : items) order.emplace_back(place(i), i);
  std::sort(order.begin(), order.end());
  return order;
}

double half_surface(const Bounds& box) {
  const Vec3 size = box.high - box.low;
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

/// The number of the first items of an order, a quarter of all at least and at most three, with
/// which both sides have the least surface for their items, and that.
std::pair<int, double> least_surface(std::span<const Bounds> boxes,
                                     const std::vector<std::pair<double, int>>& order) {
  const std::size_t n = order.size(), least = std::max<std::size_t>(1, n / 4);
  std::vector<double> cost(n + 1, 0);  // by the number on the left
  Bounds left, right;
  for (std::size_t k = 1; k < n; ++k) {
    left.include(boxes[at(order[k - 1].second)]);
    right.include(boxes[at(order[n - k].second)]);
    cost[k] += half_surface(left) * static_cast<double>(k);
    cost[n - k] += half_surface(right) * static_cast<double>(k);
  }
  std::size_t best = least;
  for (std::size_t k = least; k <= n - least; ++k)
    if (cost[k] < cost[best] * (1 - clearly_less)) best = k;
  return {static_cast<int>(best), cost[best]};
}

/// As make_tight_tree says. The number of those to the left.
int divide_by_surface(std::span<const Bounds> boxes, const Bounds& centres, std::span<int> items) {
  if (items.size() > most_swept) return halve_items(boxes, centres, items);
  std::vector<std::pair<double, int>> best_order;
  std::pair<int, double> best;
  for (int axis = 0; axis < 3; ++axis) {
    auto order = in_order(boxes, centres, items, axis);
    const std::pair<int, double> found = least_surface(boxes, order);
    if (!best_order.empty() && !(found.second < best.second * (1 - clearly_less))) continue;
    best_order = std::move(order);
    best = found;
  }
  if (best.second == 0) return halve_items(boxes, centres, items);  // points, or all in a line
  for (std::size_t k = 0; k < items.size(); ++k) items[k] = best_order[k].second;
  return best.first;
}

template <class Divide>
int add_node(FlatTree& tree, std::span<const Bounds> boxes, int first, int count, int leaf_size,
             const Divide& divide) {
  const std::span<int> items = std::span(tree.items).subspan(at(first), at(count));
  FlatTree::Node node;
  node.first = first;
  node.count = count;
  Bounds centres;
  for (const int item : items) {
    node.box.include(boxes[at(item)]);
    centres.include(boxes[at(item)].centre());
  }
  const auto index = static_cast<int>(tree.nodes.size());
  tree.nodes.push_back(node);
  if (count <= leaf_size) return index;
  const int left = divide(boxes, centres, items);
  add_node(tree, boxes, first, left, leaf_size, divide);
  const int right = add_node(tree, boxes, first + left, count - left, leaf_size, divide);
  tree.nodes[at(index)].right = right;
  return index;
}

template <class Divide>
FlatTree make_tree(std::span<const Bounds> boxes, int leaf_size, const Divide& divide) {
  FlatTree tree;
  tree.items.resize(boxes.size());
  std::iota(tree.items.begin(), tree.items.end(), 0);
  if (!boxes.empty()) add_node(tree, boxes, 0, static_cast<int>(boxes.size()), leaf_size, divide);
  return tree;
}

}  // namespace

FlatTree make_flat_tree(std::span<const Bounds> boxes, int leaf_size) {
  return make_tree(boxes, leaf_size, halve_items);
}

FlatTree make_tight_tree(std::span<const Bounds> boxes, int leaf_size) {
  return make_tree(boxes, leaf_size, divide_by_surface);
}

}  // namespace halfshade
