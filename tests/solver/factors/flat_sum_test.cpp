#include "solver/factors/flat_sum.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace halfshade {
namespace {

/// Two edges at once are what one after the other is: near, grazing and far polygons.
TEST(FlatEdges, AgreeWithFlatSum) {
  test::Random random(5);
  for (int k = 0; k < 2000; ++k) {
    const double size = std::pow(10., random(-3, 1));
    const Vec3 point(random(-1, 1), random(-1, 1), std::pow(10., random(-4, 0)));
    const Vec3 normal = Vec3(random(-1, 1), random(-1, 1), random(-1, 0)).normalized();
    const int count = 3 + random.below(6);
    FlatSum sum(point, normal);
    std::vector<double> x, y;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * (i + .9 * random(0, 1)) / count;
      x.push_back(.3 + size * std::cos(angle));
      y.push_back(-.2 + size * std::sin(angle));
    }
    sum.start({x.back(), y.back()});
    for (std::size_t i = 0; i < x.size(); ++i) sum.add({x[i], y[i]});
    FlatEdges edges;
    edges.add(x.data(), y.data(), x.size());
    EXPECT_NEAR(edges.form_factor(point, normal), sum.form_factor(), 1e-14);
  }
}

}  // namespace
}  // namespace halfshade
