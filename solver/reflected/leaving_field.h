#pragma once

#include "solver/reflected/quick_field.h"
#include "solver/reflected/reflected_mesh.h"

#include <vector>

namespace halfshade {

/// A field of order ≤ max_reflected_order on the triangles of a forest, for the many places where
/// rays end: as many powers of each, whatever its order, so that nothing is to be looked up or
/// decided first, which takes longer than the sum.
class LeavingField {
 public:
  LeavingField(const ReflectedMesh& mesh, const ElementField& field);

  Rgb value(int triangle, const TrianglePlace& place) const {
    return sum_of_powers(powers_of(triangle), order_, place);
  }

  /// Has the powers of a triangle fetched from memory, for a value some places later.
  void prefetch(int triangle) const {
#ifdef __GNUC__
    constexpr std::size_t line = 64;
    const auto* powers = reinterpret_cast<const char*>(powers_of(triangle));
    for (std::size_t k = 0; k < at(basis_size(order_)) * sizeof(Rgb); k += line)
      __builtin_prefetch(powers + k);
#endif
  }

 private:
  const Rgb* powers_of(int triangle) const {
    return powers_.data() + at(triangle) * at(basis_size(order_));
  }

  int order_ = 0;            ///< the highest
  std::vector<Rgb> powers_;  ///< of leaves; those of other triangles say nothing
};

}  // namespace halfshade
