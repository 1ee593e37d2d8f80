#include "meshing/rays/triangle_tree.h"

#include "meshing/core/error.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <memory>
#include <new>
#include <type_traits>

namespace halfshade {
namespace {

constexpr unsigned leaf_size = 4;  // triangles

/// A node as Embree builds it.
struct RawNode {
  std::array<RawNode*, 2> children{};
  std::array<int, leaf_size> triangles{};
  int count = 0;  // of a leaf's triangles; 0 in inner nodes
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(RawNode), alignof(RawNode))) RawNode;
}

void set_children(void* node, void** children, unsigned count, void*) {
  for (unsigned i = 0; i < count; ++i)
    static_cast<RawNode*>(node)->children[i] = static_cast<RawNode*>(children[i]);
}

void set_bounds(void*, const RTCBounds**, unsigned, void*) {}  // computed later, in double

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives,
                  std::size_t count, void*) {
  auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(RawNode), alignof(RawNode))) RawNode;
  leaf->count = static_cast<int>(count);
  for (std::size_t i = 0; i < count; ++i)
    leaf->triangles[i] = static_cast<int>(primitives[i].primID);
  return leaf;
}

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};
template <class Handle>
using Owner = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

using Corners = std::vector<std::array<Vec3, 3>>;

/// Boxes in single precision, scaled to [−1, 1]: the shape of the tree need not be exact.
std::vector<RTCBuildPrimitive> boxes(const Corners& triangles) {
  double reach = 0;
  for (const auto& t : triangles)
    for (const Vec3& p : t) reach = std::max(reach, p.lpNorm<Eigen::Infinity>());
  const double scale = reach > 0 ? 1 / reach : 1;
  std::vector<RTCBuildPrimitive> out(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [p, q, r] = triangles[t];
    const Eigen::Vector3f low = (scale * p.cwiseMin(q).cwiseMin(r)).cast<float>();
    const Eigen::Vector3f high = (scale * p.cwiseMax(q).cwiseMax(r)).cast<float>();
    out[t] = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), static_cast<unsigned>(t)};
  }
  return out;
}

}  // namespace

struct TreeBuilder {
  TriangleTree& tree;
  const Corners& corners;

  /// Appends a subtree, depth first.
  int add(const RawNode& raw) {
    const std::size_t index = tree.nodes_.size();
    tree.nodes_.emplace_back();
    TriangleTree::Node node;
    if (raw.count > 0) {
      node.first = static_cast<int>(tree.ids_.size());
      node.count = raw.count;
      node.low = node.high = corners[static_cast<std::size_t>(raw.triangles[0])][0];
      for (int i = 0; i < raw.count; ++i) {
        const int id = raw.triangles[static_cast<std::size_t>(i)];
        tree.ids_.push_back(id);
        tree.triangles_.push_back(corners[static_cast<std::size_t>(id)]);
        for (const Vec3& p : tree.triangles_.back()) {
          node.low = node.low.cwiseMin(p);
          node.high = node.high.cwiseMax(p);
        }
      }
    } else {
      const auto left = static_cast<std::size_t>(add(*raw.children[0]));
      node.right = add(*raw.children[1]);
      const auto right = static_cast<std::size_t>(node.right);
      node.low = tree.nodes_[left].low.cwiseMin(tree.nodes_[right].low);
      node.high = tree.nodes_[left].high.cwiseMax(tree.nodes_[right].high);
    }
    tree.nodes_[index] = node;
    return static_cast<int>(index);
  }
};

TriangleTree::TriangleTree(const TriangleSoup& soup, const Vec3& centre) {
  if (soup.triangles.empty()) return;
  Corners corners(soup.triangles.size());
  for (std::size_t t = 0; t < corners.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      corners[t][k] = soup.points[static_cast<std::size_t>(soup.triangles[t][k])] - centre;
  std::vector<RTCBuildPrimitive> primitives = boxes(corners);

  const Owner<RTCDevice> device(rtcNewDevice(nullptr));
  const Owner<RTCBVH> bvh(rtcNewBVH(device.get()));
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.maxBranchingFactor = 2;
  arguments.maxLeafSize = leaf_size;
  arguments.bvh = bvh.get();
  arguments.primitives = primitives.data();
  arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = create_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = create_leaf;
  const auto* root = static_cast<const RawNode*>(rtcBuildBVH(&arguments));
  if (root == nullptr)
    throw Error(ErrorCode::too_large, "TriangleTree", "not enough memory for the triangles");
  triangles_.reserve(corners.size());
  ids_.reserve(corners.size());
  TreeBuilder{*this, corners}.add(*root);
}

void TriangleTree::find(const Shaft& shaft, std::vector<int>& triangles) const {
  if (nodes_.empty()) return;
  std::vector<std::pair<int, SideMask>> stack = {{0, all_sides(shaft)}};
  while (!stack.empty()) {
    auto [index, mask] = stack.back();
    stack.pop_back();
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (is_outside(shaft, node.low, node.high, mask)) continue;
    if (node.right >= 0) {
      stack.emplace_back(node.right, mask);
      stack.emplace_back(index + 1, mask);
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      if (!is_harmless(shaft, triangles_[static_cast<std::size_t>(i)], mask))
        triangles.push_back(ids_[static_cast<std::size_t>(i)]);
  }
}

}  // namespace halfshade
