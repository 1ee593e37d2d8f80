#include "meshing/geometry/flat_tree.h"

#include "tests/support/random.h"
#include "tests/support/room_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

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

class EachFlatTree
    : public testing::TestWithParam<FlatTree (*)(std::span<const Bounds> boxes, int leaf_size)> {};
INSTANTIATE_TEST_SUITE_P(HalvedAndTight, EachFlatTree,
                         testing::Values(make_flat_tree, make_tight_tree));

TEST_P(EachFlatTree, WithOneItemToALeafFindsWhatComparingAllFinds) {
  const std::vector<Bounds> boxes = random_boxes(300, 9);
  const FlatTree tree = GetParam()(boxes, 1);
  for (const Bounds& probe : random_boxes(50, 10)) {
    std::vector<int> found;
    visit_overlaps(tree, probe, [&](int i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, meeting(boxes, probe));
  }
  visit_overlaps(GetParam()({}, 1), boxes[0], [](int) { ADD_FAILURE(); });
}

TEST_P(EachFlatTree, WithLargerLeavesMissesNothing) {
  const std::vector<Bounds> boxes = random_boxes(300, 9);
  const FlatTree tree = GetParam()(boxes, 4);
  for (const Bounds& probe : random_boxes(50, 10)) {
    std::vector<int> found;
    visit_overlaps(tree, probe, [&](int i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    const std::vector<int> expected = meeting(boxes, probe);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
  }
}

TEST_P(EachFlatTree, ManyEqualBoxesStayWithinTheStack) {
  const std::vector<Bounds> boxes(1000, Bounds{Vec3::Zero(), Vec3::Ones()});
  int count = 0;
  visit_overlaps(GetParam()(boxes, 1), boxes[0], [&](int) { ++count; });
  EXPECT_EQ(count, 1000);
}

int depth_below(const FlatTree& tree, int node) {
  const FlatTree::Node& own = tree.nodes[at(node)];
  return own.right < 0 ? 1
                       : 1 + std::max(depth_below(tree, node + 1), depth_below(tree, own.right));
}

/// The least surface is that of all but the largest, again and again.
TEST_P(EachFlatTree, BoxesEachTwiceAsLargeStayWithinTheStack) {
  std::vector<Bounds> boxes;
  for (int k = 0; k < 900; ++k) {
    const Vec3 high = Vec3::Constant(std::ldexp(1., k - 450));
    boxes.push_back({0.9 * high, high});
  }
  EXPECT_LE(depth_below(GetParam()(boxes, 1), 0), FlatTree::max_stack);
}

TEST_P(EachFlatTree, SizesBeyondSquaresAndPointsAreTakenToo) {
  for (const double size : {1e-200, 1e200, 0.}) {
    std::vector<Bounds> boxes = random_boxes(100, 12);
    for (Bounds& box : boxes) box = {size * box.low, size * box.high};
    const FlatTree tree = GetParam()(boxes, 1);
    int count = 0;
    visit_overlaps(tree, tree.nodes[0].box, [&](int) { ++count; });
    EXPECT_EQ(count, 100);
  }
}

/// As flat_tree.h says of furnished rooms: rays from anywhere in one to anywhere else.
TEST(FlatTree, ATightOneHasAThirdFewerBoxesToPass) {
  const Scene room = test::furnished_room(300);
  std::vector<Bounds> boxes;
  for (const Face& face : room.faces) {
    Bounds& box = boxes.emplace_back();
    for (const int v : face.vertices) box.include(room.vertices[at(v)]);
  }
  const auto passed = [&](const FlatTree& tree) {
    const Bounds all = tree.nodes[0].box;
    test::Random random(14);
    int count = 0;
    for (int k = 0; k < 1000; ++k) {
      const Vec3 from = random.in_box(all.low, all.high), to = random.in_box(all.low, all.high);
      walk_tree(
          tree,
          [&](int node) {
            ++count;
            const Bounds& box = tree.nodes[at(node)].box;
            const Vec3 a = (box.low - from).cwiseQuotient(to - from);
            const Vec3 b = (box.high - from).cwiseQuotient(to - from);
            return std::max(a.cwiseMin(b).maxCoeff(), 0.) > std::min(a.cwiseMax(b).minCoeff(), 1.);
          },
          [](int) {});
    }
    return count;
  };
  EXPECT_LT(passed(make_tight_tree(boxes, 1)), 2. / 3 * passed(make_flat_tree(boxes, 1)));
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
