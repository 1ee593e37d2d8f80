#pragma once

#include "meshing/core/types.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// The corners of triangles, grouped into fans: corners that lie in one point and can be reached
/// from each other through triangles around it, over edges that have a neighbour.
struct CornerFans {
  int count = 0;
  std::vector<std::array<int, 3>> of_corner;  ///< triangle, corner → fan; by first appearance
};

/// `neighbours[t][k]` is the triangle across the edge from corner k to k+1, or −1; a triangle
/// that `neighbours` names shares two points with t.
CornerFans corner_fans(std::span<const std::array<int, 3>> triangles,
                       std::span<const std::array<int, 3>> neighbours);

/// Neighbours over edges that exactly two triangles have; −1 elsewhere.
std::vector<std::array<int, 3>> edge_neighbours(std::span<const std::array<int, 3>> triangles);

}  // namespace halfshade
