#include "meshing/rays/triangle_tree.h"

#include <numeric>

namespace halfshade {

TriangleTree::TriangleTree(const TriangleSoup& soup, const Vec3& centre) {
  std::vector<std::array<Vec3, 3>> corners(soup.triangles.size());
  std::vector<Bounds> boxes(corners.size());
  for (std::size_t t = 0; t < corners.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      corners[t][k] = soup.points[at(soup.triangles[t][k])] - centre;
      boxes[t].include(corners[t][k]);
    }
  tree_ = make_flat_tree(boxes);
  ids_ = tree_.items;
  for (const int id : ids_) triangles_.push_back(corners[at(id)]);
  std::iota(tree_.items.begin(), tree_.items.end(), 0);
}

void TriangleTree::find(const Shaft& shaft, std::vector<int>& triangles) const {
  const auto skip = [&](int node, SideMask& mask) {
    const Bounds& box = tree_.nodes[at(node)].box;
    return is_outside(shaft, box.low, box.high, mask);
  };
  walk_tree(tree_, all_sides(shaft), skip, [&](int i, SideMask mask) {
    if (!is_harmless(shaft, triangles_[at(i)], mask)) triangles.push_back(ids_[at(i)]);
  });
}

}  // namespace halfshade
