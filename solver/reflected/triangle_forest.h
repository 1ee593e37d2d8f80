#pragma once

#include "solver/elements/element_lookup.h"

#include <array>
#include <vector>

namespace halfshade {

/// k of the longest edge of a triangle, from corner k to the next; the first of those that are
/// equal but for rounding.
int longest_edge(const std::array<Vec3, 3>& corner);

/// Triangles that cover surfaces, each bisected as often as one likes, whatever its neighbours do.
/// Triangle i < root_count() is element i of the table that the forest is made of.
class TriangleForest {
 public:
  explicit TriangleForest(const ElementTable& roots);

  int count() const { return static_cast<int>(triangles_.size()); }
  int root_count() const { return root_count_; }
  bool is_leaf(int triangle) const { return splits_[at(triangle)].child < 0; }
  int root(int triangle) const { return triangles_[at(triangle)].root; }
  int level(int triangle) const { return triangles_[at(triangle)].level; }
  const std::array<Vec3, 3>& corners(int triangle) const { return triangles_[at(triangle)].corner; }
  double area(int triangle) const { return triangles_[at(triangle)].area; }

  /// Cuts a leaf from the middle of its longest edge to the corner opposite.
  void bisect(int triangle);

  /// The edge from this corner to the next is the one that bisect() cuts.
  int cut(int triangle) const { return splits_[at(triangle)].cut; }

  /// The first half of a triangle that is no leaf; the second follows it.
  int first_half(int triangle) const { return splits_[at(triangle)].child; }

  /// The leaf that holds a place, and where in it.
  ForestPlace leaf_at(ForestPlace place) const;

  /// The leaf that holds a point of a surface; see ElementLookup::find.
  ForestPlace leaf_at(int surface, const Vec3& position) const;

 private:
  struct Triangle {
    std::array<Vec3, 3> corner;
    double area = 0;
    int root = 0, level = 0;
  };
  /// Apart, for it is all that a search from the root reads.
  struct Split {
    int child = -1;  // the first of two; −1 in leaves
    int cut = 0;     // the edge from this corner to the next is the one that is cut
  };

  void add(const Triangle& triangle);

  std::vector<Triangle> triangles_;
  std::vector<Split> splits_;  ///< of each
  int root_count_ = 0;
  ElementLookup roots_;
};

}  // namespace halfshade
