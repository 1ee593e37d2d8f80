#include "meshing/geometry/flat_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace halfshade {
namespace {

std::vector<Bounds> random_boxes(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Bounds> boxes;
  for (int k = 0; k < count; ++k) {
    const Vec3 low(uniform(random), uniform(random), uniform(random));
    boxes.push_back({low, low + 0.2 * Vec3(uniform(random), uniform(random), uniform(random))});
  }
  return boxes;
}

std::vector<int> meeting(const std::vector<Bounds>& boxes, const Bounds& probe) {
  std::vector<int> result;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (boxes[i].meets(probe)) result.push_back(static_cast<int>(i));
  return result;
}

TEST(FlatTree, WithOneItemToALeafFindsWhatComparingAllFinds) {
  const std::vector<Bounds> boxes = random_boxes(300, 9);
  const FlatTree tree = make_flat_tree(boxes, 1);
  for (const Bounds& probe : random_boxes(50, 10)) {
    std::vector<int> found;
    visit_overlaps(tree, probe, [&](int i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, meeting(boxes, probe));
  }
  visit_overlaps(make_flat_tree({}), boxes[0], [](int) { ADD_FAILURE(); });
}

TEST(FlatTree, WithLargerLeavesMissesNothing) {
  const std::vector<Bounds> boxes = random_boxes(300, 9);
  const FlatTree tree = make_flat_tree(boxes);
  for (const Bounds& probe : random_boxes(50, 10)) {
    std::vector<int> found;
    visit_overlaps(tree, probe, [&](int i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    const std::vector<int> expected = meeting(boxes, probe);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
  }
}

TEST(FlatTree, ManyEqualBoxesStayWithinTheStack) {
  const std::vector<Bounds> boxes(1000, Bounds{Vec3::Zero(), Vec3::Ones()});
  int count = 0;
  visit_overlaps(make_flat_tree(boxes, 1), boxes[0], [&](int) { ++count; });
  EXPECT_EQ(count, 1000);
}

TEST(FlatTree, AWalkHandsItsStateDownwards) {
  const std::vector<Bounds> boxes = random_boxes(100, 11);
  const FlatTree tree = make_flat_tree(boxes, 2);
  // The smallest box above: each node may only shrink it.
  const auto skip = [&](int node, double& size) {
    const double own = tree.nodes[at(node)].box.half_size().sum();
    EXPECT_LE(own, size);
    size = own;
    return false;
  };
  int count = 0;
  walk_tree(tree, 1e9, skip, [&](int item, double size) {
    EXPECT_LE(boxes[at(item)].half_size().sum(), size);
    ++count;
  });
  EXPECT_EQ(count, 100);
}

TEST(Bounds, EmptyOnesMeetNothingAndGrowToWhatTheyInclude) {
  Bounds box;
  EXPECT_FALSE(box.meets(Bounds{Vec3::Zero(), Vec3::Ones()}));
  box.include(Vec3(1, 2, 3));
  EXPECT_EQ(box.low, Vec3(1, 2, 3));
  EXPECT_EQ(box.high, Vec3(1, 2, 3));
  EXPECT_TRUE(box.grown(1).meets(Bounds{Vec3::Zero(), Vec3(0, 1, 2)}));
  EXPECT_FALSE(box.grown(0.9).meets(Bounds{Vec3::Zero(), Vec3(0, 1, 2)}));
}

}  // namespace
}  // namespace halfshade
