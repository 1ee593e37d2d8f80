#pragma once

#include "meshing/geometry/flat_tree.h"
#include "meshing/patches/element_table.h"
#include "solver/elements/polynomial.h"

#include <array>
#include <vector>

namespace halfshade {

/// A place in a triangle of a forest.
struct ForestPlace {
  int triangle = -1;  ///< −1: nowhere
  TrianglePlace place = TrianglePlace::Zero();
};

/// Triangles that cover surfaces, each bisected as often as one likes, whatever its neighbours do.
/// Triangle i < root_count() is element i of the table that the forest is made of.
class TriangleForest {
 public:
  explicit TriangleForest(const ElementTable& roots);

  int count() const { return static_cast<int>(triangles_.size()); }
  int root_count() const { return root_count_; }
  bool is_leaf(int triangle) const { return triangles_[at(triangle)].child < 0; }
  int root(int triangle) const { return triangles_[at(triangle)].root; }
  int level(int triangle) const { return triangles_[at(triangle)].level; }
  const std::array<Vec3, 3>& corners(int triangle) const { return triangles_[at(triangle)].corner; }
  double area(int triangle) const { return triangles_[at(triangle)].area; }

  /// Cuts a leaf from the middle of its longest edge to the corner opposite.
  void bisect(int triangle);

  /// The first half of a triangle that is no leaf; the second follows it.
  int first_half(int triangle) const { return triangles_[at(triangle)].child; }

  /// The leaf that holds a place, and where in it.
  ForestPlace leaf_at(ForestPlace place) const;

  /// The leaf that holds a point of a surface: the nearest by barycentric coordinates if rounding
  /// puts the point outside of all. Nowhere if the surface has no triangles.
  ForestPlace leaf_at(int surface, const Vec3& position) const;

 private:
  struct Triangle {
    std::array<Vec3, 3> corner;
    double area = 0;
    int root = 0, level = 0;
    int child = -1;  // the first of two; −1 in leaves
    int cut = 0;     // the edge from this corner to the next is the one that is cut
  };

  /// Takes points of a triangle's plane to places.
  struct PlaceMap {
    Vec3 origin;
    Eigen::Matrix<double, 2, 3> slope;

    TrianglePlace operator()(const Vec3& p) const { return slope * (p - origin); }
  };

  std::vector<Triangle> triangles_;
  int root_count_ = 0;
  std::vector<PlaceMap> place_map_;           // of each root
  std::vector<int> surface_;                  // of each root
  std::vector<std::vector<int>> of_surface_;  // its roots
  FlatTree tree_;                             // of roots
};

}  // namespace halfshade
