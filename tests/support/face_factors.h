#pragma once

#include "solver/factors/factor_matrix.h"

namespace halfshade::test {

/// Between the faces of a scene, exactly.
inline FactorMatrix face_factors(const Scene& scene, double tolerance) {
  FactorOptions options;
  options.unit = FactorUnit::face;
  options.method = FactorMethod::exact;
  options.tolerance = tolerance;
  return form_factor_matrix(scene, options);
}

}  // namespace halfshade::test
