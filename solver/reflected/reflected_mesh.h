#pragma once

#include "solver/elements/element_field.h"
#include "solver/elements/quadrature.h"
#include "solver/reflected/huge_roots.h"
#include "solver/reflected/triangle_forest.h"

#include <span>
#include <vector>

namespace halfshade {

/// The highest order of elements of reflected light.
inline constexpr int max_reflected_order = 3;

/// The elements of reflected light: the leaves of a forest.
struct ReflectedMesh {
  explicit ReflectedMesh(const ElementTable& roots) : forest(roots) {}

  TriangleForest forest;
  HugeRoots huge;
  int highest_order = 0;
  std::vector<int> order;            ///< triangle → order of its polynomial
  std::vector<bool> stays_constant;  ///< triangle → its order is not raised
  /// Element → leaf: root by root, half by half, so that those which follow each other are close
  /// and the memory that rays from them read is the same.
  std::vector<int> triangle;
  std::vector<int> element;  ///< triangle → element, −1 where it is split

  int count() const { return static_cast<int>(triangle.size()); }
  int root(int e) const { return forest.root(triangle[at(e)]); }
  /// Whether it counts where others are compared with all.
  bool counts(int e) const { return !huge(root(e)); }
  double area(int e) const { return forest.area(triangle[at(e)]); }
  Vec3 position(int e, const TrianglePlace& place) const {
    return halfshade::position(forest.corners(triangle[at(e)]), place);
  }
};

/// Bisects roots until no triangle is longer than `length`: the geometric mean of its longest edge
/// and the edge of an equilateral triangle of its area, so that slender ones stay few. Stops at
/// `max_elements`. Elements much smaller have lower orders. Triangles of huge surfaces may be as
/// long as they are far from everything else.
ReflectedMesh make_reflected_mesh(const ElementTable& roots, double length, int order,
                                  int max_elements, const HugeRoots& huge = {});

/// Raises the order of elements where that is the next thing to do, else bisects them and their
/// parts, each as many times as `times` says. One entry of it a wanted element.
void refine(ReflectedMesh& mesh, std::span<const int> wanted, const std::vector<int>& times);

/// Makes elements constant, and keeps them so; their parts may be more.
void make_constant(ReflectedMesh& mesh, std::span<const int> elements);

/// Every element bisected that many times, and its parts as well.
ReflectedMesh bisected(ReflectedMesh mesh, int times);

/// Zero on all elements.
ElementField zero_field(const ReflectedMesh& mesh);

/// As arrays; every element has points of its own, and no neighbours.
ElementTable element_table(const ReflectedMesh& mesh, const ElementTable& roots);

/// Nodes at which an element of an order is evaluated: a rule exact for twice the order, so that
/// `fit` takes values to the coefficients of their projection.
struct ElementNodes {
  std::vector<TrianglePlace> places;
  Eigen::MatrixXd fit;
  /// Mean square over the element of what noise of unit variance at one node makes of the
  /// polynomials of each degree: one row a degree, one column a node.
  Eigen::MatrixXd spread;
};
const ElementNodes& element_nodes_of(int order);

}  // namespace halfshade
