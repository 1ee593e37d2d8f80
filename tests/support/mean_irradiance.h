#pragma once

#include "solver/pipeline/solve.h"

namespace halfshade::test {

/// Of all surfaces, by channel, W/m².
inline Rgb mean_irradiance(const SolveResult& result) {
  const Eigen::Map<const Eigen::ArrayXd> area(result.elements.area.data(), result.elements.count());
  return (result.solution.irradiance.colwise() * area).colwise().sum().transpose() / area.sum();
}

}  // namespace halfshade::test
