#include "solver/direct/emitter_tree.h"

#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace halfshade {
namespace {

Bounds box_of(const RayEmitter& emitter) {
  Bounds box;
  for (const auto& ring : emitter.target.rings)
    for (const Vec3& corner : ring) box.include(corner);
  return box;
}

}  // namespace

EmitterTree make_emitter_tree(std::vector<RayEmitter> emitters) {
  EmitterTree result;
  result.emitters = std::move(emitters);
  std::vector<Bounds> boxes;
  for (const RayEmitter& emitter : result.emitters) boxes.push_back(box_of(emitter));
  result.tree = make_flat_tree(boxes, 1);
  for (const FlatTree::Node& node : result.tree.nodes) {
    EmitterTree::Group& group = result.groups.emplace_back();
    for (int i = node.first; i < node.first + node.count; ++i) {
      const RayEmitter& emitter = result.emitters[at(result.tree.items[at(i)])];
      group.normals.include(emitter.target.normal);
      group.power += emitter.area() * emitter.target.strength;
    }
  }
  return result;
}

// Light of an emitter is the integral over its area of strength · cos θ cos θ' / (π r²).
double most_light(const EmitterTree& tree, int node, const SurfacePoint& point) {
  const Bounds& box = tree.tree.nodes[at(node)].box;
  const EmitterTree::Group& group = tree.groups[at(node)];
  const Vec3 low = box.low - point.position, high = box.high - point.position;
  double height = 0, facing = 0, square = 0;
  for (int k = 0; k < 3; ++k) {
    height += std::max(point.normal[k] * low[k], point.normal[k] * high[k]);
    const double least = group.normals.low[k], most = group.normals.high[k];
    facing -= std::min({least * low[k], least * high[k], most * low[k], most * high[k]});
    const double gap = std::max({low[k], -high[k], 0.});
    square += gap * gap;
  }
  if (!(height > 0 && facing > 0)) return 0;
  if (!(square > 0)) return std::numeric_limits<double>::infinity();
  const double distance = std::sqrt(square);
  return group.power / std::numbers::pi * (std::min(height, distance) / square) *
         (std::min(facing, distance) / square);
}

DrawnEmitter draw_emitter(const EmitterTree& tree, int node, const SurfacePoint& point,
                          std::uint64_t bits) {
  double light = most_light(tree, node, point);
  while (tree.tree.nodes[at(node)].right >= 0) {
    const int left = node + 1, right = tree.tree.nodes[at(node)].right;
    const double of_left = most_light(tree, left, point);
    const double both = of_left + most_light(tree, right, point);
    if (!(both > 0)) return {};
    bits = mix_bits(bits);
    const double share = of_left / both;
    const bool is_left = unit_share(bits) < share;
    light *= is_left ? share : 1 - share;
    node = is_left ? left : right;
  }
  return {&first_of(tree, node), light};
}

}  // namespace halfshade
