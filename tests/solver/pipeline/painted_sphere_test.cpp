#include "tests/support/painted_sphere.h"

#include "solver/pipeline/solve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

/// Whatever is painted on a sphere, its irradiance is the same all over.
TEST(PaintedSphere, IsLitEvenly) {
  constexpr double want = 8. / 3, flatness = 2e-3;  // of 2,048 triangles
  SolveOptions options;
  options.tolerance = 1e-2;
  const SolveResult result = solve(test::painted_sphere(4), options);
  EXPECT_TRUE(result.not_reached.empty()) << result.not_reached;
  const ChannelArray irradiance = means(result.irradiance);
  double square = 0, area = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    const double own = result.elements.area[at(e)];
    square += own * std::pow(irradiance(e, 0) / want - 1, 2);
    area += own;
  }
  EXPECT_LT(std::sqrt(square / area), options.tolerance + flatness);
}

}  // namespace
}  // namespace halfshade
