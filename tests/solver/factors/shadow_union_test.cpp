#include "solver/factors/shadow_union.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace halfshade {
namespace {

/// Corners of an ellipse, counter-clockwise.
struct Oval {
  std::vector<double> x, y;

  Oval(const Vec2& centre, double width, double height, int corners) {
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.3) / corners;
      x.push_back(centre.x() + width * std::cos(angle));
      y.push_back(centre.y() + height * std::sin(angle));
    }
  }
  ShadowCut::Corners corners() const { return {x.data(), y.data(), x.size()}; }
  std::vector<ShadowSide> sides() const {
    std::vector<ShadowSide> sides;
    for (std::size_t from = x.size() - 1, to = 0; to < x.size(); from = to++) {
      const double ax = y[to] - y[from], ay = x[from] - x[to];
      sides.push_back({ax, ay, -(ax * x[to] + ay * y[to])});
    }
    return sides;
  }
  FlatBox box() const {
    FlatBox box;
    for (std::size_t k = 0; k < x.size(); ++k) box.add(x[k], y[k]);
    return box;
  }
};

/// From a point before the plane.
double form_factor(FlatEdges& edges) { return edges.form_factor({0.1, 0.2, 0.7}, {0, 0, -1}); }

TEST(ShadowUnion, CoversWhatShadowsCutOffOneAfterTheOther) {
  test::Random random(3);
  int together = 0;
  for (int k = 0; k < 300; ++k) {
    const Oval target({0, 0}, 1, 0.8, 5);
    std::vector<Oval> ovals;
    for (int s = 0; s < 1 + k % 8; ++s)
      ovals.emplace_back(Vec2(random(-.9, .9), random(-.9, .9)), random(.1, .8), random(.1, .8),
                         3 + static_cast<int>(random(0, 20)));
    if (k % 5 == 0) ovals.push_back(ovals.front());  // twice the same
    std::vector<std::vector<ShadowSide>> sides;
    for (const Oval& oval : ovals) sides.push_back(oval.sides());
    std::vector<FlatShadow> shadows;
    for (std::size_t s = 0; s < ovals.size(); ++s) shadows.push_back({sides[s], ovals[s].box()});
    const double nearness = 1e-12;
    FlatEdges all, one_by_one;
    ShadowUnion shadow_union;
    shadow_union.add_edges(target.corners(), shadows, nearness, all);
    ShadowCut cut;
    cut.add(target.corners());
    double sum = 0;
    for (const FlatShadow& shadow : shadows)
      cut.cut_off(shadow.sides, shadow.box, nearness, true, [&](const ShadowCut::Corners& part) {
        one_by_one.add(part.x, part.y, part.count);
        sum += 1;
      });
    EXPECT_NEAR(form_factor(all), form_factor(one_by_one), 1e-13);
    together += sum > 3;
  }
  EXPECT_GT(together, 100);
}

}  // namespace
}  // namespace halfshade
