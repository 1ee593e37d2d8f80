#pragma once

#include "solver/direct/direct_light.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"
#include "tests/support/random.h"

#include <cmath>

namespace halfshade::test {

inline SolveOptions directly(double tolerance) {
  SolveOptions options;
  options.tolerance = tolerance;
  options.radiosity.bounces = 0;
  return options;
}

/// Relative L2 error of a solution of direct light, at so many random points of each element.
inline double direct_error(const PreparedScene& prepared, const SolveResult& result,
                           int points = 1) {
  Random random(3);
  double square_error = 0, square = 0;
  for (int k = 0; k < points * result.elements.count(); ++k) {
    const int e = k / points;
    double s = random(0, 1), t = random(0, 1);
    if (s + t > 1) s = 1 - s, t = 1 - t;
    const Vec3 p = position(result.elements.triangle(e), {s, t});
    const Rgb exact =
        prepared.direct_light().irradiance({p, result.elements.normal[at(e)]}).irradiance;
    const double area = result.elements.area[at(e)];
    square += area * exact.matrix().squaredNorm();
    square_error += area * (value_at(result.irradiance, e, {s, t}) - exact).matrix().squaredNorm();
  }
  return std::sqrt(square_error / square);
}

}  // namespace halfshade::test
