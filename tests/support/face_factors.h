#pragma once

#include "solver/factors/factor_matrix.h"

#include <gtest/gtest.h>

namespace halfshade::test {

inline FactorMatrix exact_factors(const Scene& scene, FactorUnit unit, double tolerance) {
  FactorOptions options;
  options.unit = unit;
  options.method = FactorMethod::exact;
  options.tolerance = tolerance;
  return form_factor_matrix(scene, options);
}

inline FactorMatrix face_factors(const Scene& scene, double tolerance) {
  return exact_factors(scene, FactorUnit::face, tolerance);
}

inline FactorMatrix material_factors(const Scene& scene, double tolerance) {
  return exact_factors(scene, FactorUnit::material, tolerance);
}

/// Two matrices of the same rows are as near to each other as both claim.
inline void expect_within_errors(const FactorMatrix& a, const FactorMatrix& b) {
  for (Eigen::Index i = 0; i < a.area.size(); ++i) {
    const double error = a.error[i] + b.error[i];
    EXPECT_NEAR(a.space[i], b.space[i], error);
    EXPECT_NEAR(a.backs[i], b.backs[i], error);
    for (Eigen::Index j = 0; j < a.area.size(); ++j)
      EXPECT_NEAR(a.factors(i, j), b.factors(i, j), error);
  }
}

}  // namespace halfshade::test
