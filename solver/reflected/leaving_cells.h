#pragma once

#include "solver/reflected/huge_roots.h"
#include "solver/reflected/reflecting_scene.h"

#include <array>
#include <functional>
#include <vector>

namespace halfshade {

/// Roots cut in cells, and the mean of what leaves each: from afar that is as good as to ask at
/// each place, takes a fraction of the time and has less noise.
class LeavingCells {
 public:
  /// Light that leaves a point of a root.
  using Leaving = std::function<Rgb(int root, const Vec3& position)>;

  /// Roots have none.
  LeavingCells() = default;

  /// Cells of about the same size, `wanted` in all and at least one a root. Of each the mean of a
  /// few random points.
  LeavingCells(const ReflectingScene& scene, const HugeRoots& huge, double wanted,
               const Leaving& leaving);

  bool empty() const { return mean_.empty(); }

  /// The numbers of a root's cells, from first(root) to first(root + 1).
  int first(int root) const { return first_[at(root)]; }

  /// The number of the cell that a place of a root lies in.
  int find(int root, const TrianglePlace& place) const;

  /// Where its corners are on its root.
  std::array<TrianglePlace, 3> corners(int root, int cell) const;

  Rgb mean(int cell) const { return mean_[at(cell)].cast<double>(); }

  /// Whether a cell of the root is small beside its distance.
  bool is_far(int root, double square_distance) const {
    constexpr double many_times = 4;
    return square_distance > many_times * many_times * square_size_[at(root)];
  }

 private:
  std::vector<int> columns_;         ///< of a root: cells along an edge
  std::vector<int> first_;           ///< one more than roots
  std::vector<double> square_size_;  ///< of a root: of the longest edge of its cells
  std::vector<Eigen::Array3f> mean_;
};

/// A random place in a triangle, for two random numbers.
TrianglePlace place_in(const std::array<TrianglePlace, 3>& corners, double u, double v);

}  // namespace halfshade
