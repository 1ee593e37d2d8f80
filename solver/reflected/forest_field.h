#pragma once

#include "solver/elements/element_field.h"
#include "solver/reflected/reflected_mesh.h"

namespace halfshade {

/// Order of the polynomial that stands for what the leaves below a triangle of the forest carry.
int forest_order(const ReflectedMesh& mesh, int triangle);

/// A field on all triangles of the forest, one entry a triangle: on leaves it is the given one, on
/// others its projection, which keeps the mean and, by the highest order of the mesh, that many
/// moments.
ElementField forest_field(const ReflectedMesh& mesh, const ElementField& field);

/// The same with an order for each triangle, of which none is less than that of its halves.
ElementField forest_field(const ReflectedMesh& mesh, const ElementField& field,
                          std::vector<int> order);

/// Takes coefficients of an order on a triangle to those on a half of it, where it is cut at edge
/// `cut`; see TriangleForest::cut.
const Eigen::MatrixXd& restriction_to_half(int order, int cut, int half);

/// The same polynomials on the elements of a mesh whose elements are parts of the first one's, of
/// the same orders.
ElementField restricted(const ReflectedMesh& mesh, const ElementField& field,
                        const ReflectedMesh& fine);

}  // namespace halfshade
