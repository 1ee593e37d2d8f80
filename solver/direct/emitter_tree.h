#pragma once

#include "meshing/geometry/flat_tree.h"
#include "solver/direct/ray_emitter.h"

#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// Emitters in groups of groups, so that a point need not look at each of those that give it
/// little. What a group may give is bounded; one of it is drawn as likely as it may give light.
struct EmitterTree {
  /// Of all emitters below a node.
  struct Group {
    Bounds normals;
    double power = 0;  ///< sum of areas times strengths
  };

  std::vector<RayEmitter> emitters;
  FlatTree tree;              ///< one emitter to a leaf
  std::vector<Group> groups;  ///< one a node
};

/// Of emitters that have an area.
EmitterTree make_emitter_tree(std::vector<RayEmitter> emitters);

/// The first of the emitters below a node.
inline const RayEmitter& first_of(const EmitterTree& tree, int node) {
  return tree.emitters[at(tree.tree.items[at(tree.tree.nodes[at(node)].first)])];
}

/// W/m² (mean of the channels) that no point like this one gets more of from all emitters below a
/// node; never less than from those below its parts. Infinite within their box.
double most_light(const EmitterTree& tree, int node, const SurfacePoint& point);

struct DrawnEmitter {
  const RayEmitter* emitter = nullptr;  ///< null where it turns out that none gives any light
  /// What it stands for: no less than it can give. In the mean of draws, what emitters give over
  /// what they stand for, times most_light of the node, is what they give together.
  double light = 0;
};

/// One of the emitters below a node, by random bits.
DrawnEmitter draw_emitter(const EmitterTree& tree, int node, const SurfacePoint& point,
                          std::uint64_t bits);

/// Calls visit(emitter) for those that may give a point more than `weak` W/m², and
/// visit_group(node, most) for groups of all others, as large as give no more than that together.
template <class Visit, class VisitGroup>
void visit_emitters(const EmitterTree& tree, const SurfacePoint& point, double weak, Visit&& visit,
                    VisitGroup&& visit_group) {
  walk_tree(
      tree.tree,
      [&](int node) {
        if (tree.tree.nodes[at(node)].right < 0) return false;
        const double most = most_light(tree, node, point);
        if (most > weak) return false;
        if (most > 0) visit_group(node, most);
        return true;
      },
      [&](int item) { visit(tree.emitters[at(item)]); });
}

}  // namespace halfshade
