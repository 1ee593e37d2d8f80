#pragma once

#include "solver/elements/element_field.h"
#include "solver/reflected/reflected_mesh.h"

#include <vector>

namespace halfshade {

/// Takes coefficients of the orthonormal polynomials of an order ≤ max_reflected_order to those of
/// 1, s, t, s², st, t², s³, s²t, st², t³.
const Eigen::MatrixXd& change_to_powers(int order);

/// Σ c · (1, s, t, s², st, t², s³, s²t, st², t³) up to an order ≤ max_reflected_order.
inline Rgb sum_of_powers(const Rgb* c, int order, const TrianglePlace& place) {
  const double s = place.x(), t = place.y();
  switch (order) {
    case 0:
      return c[0];
    case 1:
      return c[0] + s * c[1] + t * c[2];
    case 2:
      return c[0] + s * (c[1] + s * c[3] + t * c[4]) + t * (c[2] + t * c[5]);
    default:
      return c[0] + s * (c[1] + s * (c[3] + s * c[6] + t * c[7]) + t * c[4]) +
             t * (c[2] + t * (c[5] + t * c[9] + s * c[8]));
  }
}

/// A field of order ≤ max_reflected_order as sums of powers, for the many places that rays ask for:
/// what takes the time is to fetch it from memory.
class QuickField {
 public:
  explicit QuickField(const ElementField& field);

  /// The same with the forest's triangles, where rays end, in the place of their elements.
  QuickField(const ReflectedMesh& mesh, const ElementField& field);

  Rgb value(int element, const TrianglePlace& place) const {
    const auto [first, order] = parts_[at(element)];
    return sum_of_powers(powers_.data() + first, order, place);
  }

  /// Of an element, up to its order, see sum_of_powers.
  const Rgb* powers(int element) const { return powers_.data() + parts_[at(element)].first; }

 private:
  struct Part {
    int first, order;  ///< the first of its powers
  };
  std::vector<Part> parts_;  ///< of each element, or triangle
  std::vector<Rgb> powers_;
};

}  // namespace halfshade
