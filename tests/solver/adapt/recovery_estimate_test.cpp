#include "solver/adapt/recovery_estimate.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

ElementTable square_elements(double max_length) {
  Scene scene;
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                    test::add_material(scene, 0.5, 1));
  PlanarMeshOptions options;
  options.max_length = max_length;
  return PatchMesh(make_sound(scene), options).elements();
}

/// Element means of a function of x and y in all channels, and the true L2 distance to it, by
/// sampling each triangle at 100 points.
template <class F>
std::pair<ChannelArray, double> projected(const ElementTable& elements, F f) {
  ChannelArray means(elements.count(), 3);
  double error = 0;
  for (int e = 0; e < elements.count(); ++e) {
    const auto t = elements.triangle(e);
    std::vector<double> values;
    for (int i = 0; i < 10; ++i)
      for (int j = 0; j < 10; ++j) {
        double u = (i + .5) / 10, v = (j + .5) / 10;
        if (u + v > 1) {
          u = 1 - u;
          v = 1 - v;
        }
        const Vec3 p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        values.push_back(f(p.x(), p.y()));
      }
    const Eigen::Map<Eigen::ArrayXd> samples(values.data(), 100);
    means.row(e).setConstant(samples.mean());
    error +=
        elements.area[static_cast<std::size_t>(e)] * (samples - samples.mean()).square().mean();
  }
  return {means, std::sqrt(error)};
}

double total(const ElementTable& elements, const Eigen::ArrayXd& estimate) {
  return std::sqrt(
      (Eigen::Map<const Eigen::ArrayXd>(elements.area.data(), elements.count()) * estimate.square())
          .sum());
}

TEST(RecoveryEstimate, ApproachesTheTrueErrorOfSmoothFunctions) {
  const auto smooth = [](double x, double y) { return 2 + std::sin(3 * x) * std::cos(2 * y); };
  for (const double length : {0.1, 0.05, 0.025}) {
    const ElementTable elements = square_elements(length);
    const auto [means, error] = projected(elements, smooth);
    const double ratio = total(elements, recovery_estimate(elements, means)) / error;
    EXPECT_NEAR(ratio, 1, 4 * length) << elements.count() << " elements";
  }
}

TEST(RecoveryEstimate, IsZeroForAConstantAndRelativeToTheNorm) {
  const ElementTable elements = square_elements(0.3);
  const ChannelArray constant = ChannelArray::Constant(elements.count(), 3, 7.);
  const Eigen::ArrayXd estimate = recovery_estimate(elements, constant);
  EXPECT_LE(estimate.maxCoeff(), 1e-14);
  EXPECT_NEAR(relative_error(elements, constant, Eigen::ArrayXd::Constant(elements.count(), 0.7)),
              0.1, 1e-12);
  EXPECT_EQ(relative_error(elements, 0 * constant, estimate), 0);
}

}  // namespace
}  // namespace halfshade
