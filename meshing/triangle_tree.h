#pragma once

#include "meshing/shaft.h"
#include "meshing/visibility.h"

#include <array>
#include <vector>

namespace halfshade {

/// A bounding-volume hierarchy in double precision for shaft queries.
class TriangleTree {
 public:
  /// All coordinates, also those of later queries, count from `centre`.
  TriangleTree(const TriangleSoup& soup, const Vec3& centre);

  /// Appends the triangles that may lie between the shaft's polygons, in no particular order.
  void find(const Shaft& shaft, std::vector<int>& triangles) const;

 private:
  struct Node {
    Vec3 low, high;
    int right = -1;            // the left child follows its parent; −1 in leaves
    int first = 0, count = 0;  // of a leaf's triangles
  };

  std::vector<Node> nodes_;
  std::vector<std::array<Vec3, 3>> triangles_;  // in the order of the leaves
  std::vector<int> ids_;

  friend struct TreeBuilder;
};

}  // namespace halfshade
