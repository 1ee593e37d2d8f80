#include "meshing/backprojection/sight_candidates.h"

#include "meshing/backprojection/sight_shaft.h"

namespace halfshade {
namespace {

/// Smaller nodes are sooner looked at by each point.
constexpr int few_items = 4;
/// More nodes than these are not cut further: what the points see is too much, or too far apart.
constexpr std::size_t many_nodes = 64;

}  // namespace

/// Level by level, so that all are cut equally far where there are many.
void CandidateSearch::narrow(const FlatTree& faces, const SightShaft& shaft,
                             const SightCandidates& from, SightCandidates& to) {
  open_.clear();
  for (const int node : from.nodes) open_.push_back({node, false});
  for (bool is_done = false; !is_done;) {
    const bool are_few = open_.size() <= many_nodes;
    next_.clear();
    is_done = true;
    for (const Open& open : open_) {
      const FlatTree::Node& node = faces.nodes[at(open.node)];
      if (!open.is_inside && shaft.is_outside(node.box)) continue;
      if (!are_few || node.count <= few_items) {
        next_.push_back({open.node, true});
        continue;
      }
      next_.push_back({open.node + 1, false});
      next_.push_back({node.right, false});
      is_done = false;
    }
    // Where they became few by being looked at once more, they may be cut further.
    is_done = is_done && (are_few || next_.size() > many_nodes);
    open_.swap(next_);
  }
  to.nodes.clear();
  for (const Open& open : open_) to.nodes.push_back(open.node);
}

SightCandidates all_candidates(const FlatTree& faces) {
  return {std::vector<int>(faces.nodes.empty() ? 0 : 1, 0)};
}

}  // namespace halfshade
