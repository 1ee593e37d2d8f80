#pragma once

#include "meshing/patches/element_table.h"
#include "solver/elements/polynomial.h"
#include "solver/elements/solution.h"

#include <vector>

namespace halfshade {

/// A polynomial on each element and channel, in the basis of basis_at. Nothing is continuous from
/// element to element.
struct ElementField {
  std::vector<int> order;     ///< of each element, 0…max_order
  std::vector<int> first;     ///< row of each element's first coefficient, and the number of rows
  ChannelArray coefficients;  ///< W/m² or whatever the field is in

  int count() const { return static_cast<int>(order.size()); }
  auto of(int element) { return coefficients.middleRows(first[at(element)], size(element)); }
  auto of(int element) const { return coefficients.middleRows(first[at(element)], size(element)); }

 private:
  int size(int element) const { return first[at(element) + 1] - first[at(element)]; }
};

/// Zero everywhere.
ElementField zero_field(std::vector<int> order);

/// The value at a place of an element.
Rgb value_at(const ElementField& field, int element, const TrianglePlace& place);

/// Its gradient on the element, in space: one row a channel.
Eigen::Matrix3d gradient_at(const ElementField& field, const ElementTable& elements, int element,
                            const TrianglePlace& place);

/// Mean over each element, one row each.
ChannelArray means(const ElementField& field);

/// ∫ |f|² over all elements, summed over the channels.
double square_integral(const ElementField& field, const ElementTable& elements);

/// Position of a place.
inline Vec3 position(const std::array<Vec3, 3>& triangle, const TrianglePlace& place) {
  return triangle[0] + place.x() * (triangle[1] - triangle[0]) +
         place.y() * (triangle[2] - triangle[0]);
}

/// The place of a point of the triangle's plane.
TrianglePlace place_of(const std::array<Vec3, 3>& triangle, const Vec3& point);

}  // namespace halfshade
