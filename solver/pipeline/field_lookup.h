#pragma once

#include "solver/elements/element_lookup.h"
#include "solver/reflected/quick_field.h"

namespace halfshade {

/// Light on elements at any point of a surface, from its polynomials. Rays ask at millions of
/// places: quick for orders up to max_reflected_order.
class FieldLookup {
 public:
  /// The field must outlive it.
  FieldLookup(const ElementTable& elements, const ElementField& field);

  /// Nowhere if the surface has no elements.
  ForestPlace place(int surface, const Vec3& position) const {
    return lookup_.find(surface, position);
  }

  /// Not below zero, where polynomials may dip to; zero where no elements are.
  Rgb operator()(int surface, const Vec3& position) const;

 private:
  ElementLookup lookup_;
  const ElementField& field_;
  QuickField low_;  ///< zero where the order is high
};

}  // namespace halfshade
