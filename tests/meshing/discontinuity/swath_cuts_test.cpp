#include "meshing/discontinuity/swath_cuts.h"

#include "meshing/discontinuity/sight_casting.h"
#include "meshing/events/events.h"
#include "tests/support/lit_scene.h"
#include "tests/support/random_swaths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace halfshade {
namespace {

using test::LitScene;
using test::SceneMaker;

void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-12) << k;
}

/// Lines in y = .01 from a point of the light through a segment at z = 1.
Swath fan() {
  Swath swath;
  swath.apex = {0, 0.01, 2};
  swath.base = {{-1, 0.01, 1}, {1, 0.01, 1}};
  return swath;
}

TEST(SwathCuts, LieWhereLinesMeetEdges) {
  const LitScene lit(SceneMaker().square_light().floor().up({-0.3, -0.2}, {0.3, 0.2}, 0.5));
  const SwathCuts cuts(lit.scene, lit.opaque, lit.emitter_scene);
  std::vector<double> found;
  cuts.between(fan(), 0, 1, found);
  // The line through x at z = 1 is at 1.5 x at the square's height and at 2 x on the floor.
  const auto at_floor = [](double x) { return 0.5 * (1 + x / 2); };
  expect_near(found, {0, at_floor(-1.9371), 0.4, 0.6, at_floor(1.9613), 1});
  cuts.between(fan(), 0.5, 0.7, found);
  expect_near(found, {0.5, 0.6, 0.7});
}

TEST(SwathCuts, LieWhereLinesMeetTheLinesInWhichSurfacesCutEachOther) {
  // Two sheets in x = ±(z − .5) cross in x = 0, z = .5: lines meet that at the middle only.
  const LitScene lit(
      SceneMaker()
          .square_light()
          .polygon({{-0.4, -1, 0.1}, {0.4, -1, 0.9}, {0.4, 1, 0.9}, {-0.4, 1, 0.1}})
          .polygon({{-0.4, -1, 0.9}, {0.4, -1, 0.1}, {0.4, 1, 0.1}, {-0.4, 1, 0.9}}));
  const SwathCuts cuts(lit.scene, lit.opaque, lit.emitter_scene);
  std::vector<double> found;
  cuts.between(fan(), 0, 1, found);
  EXPECT_TRUE(
      std::any_of(found.begin(), found.end(), [](double t) { return std::abs(t - 0.5) < 1e-9; }));
}

TEST(SwathCuts, AStretchIsHiddenAsLongAsItsLinesPassThroughATriangle) {
  test::Random random(12);
  int found = 0, whole = 0, ended = 0;
  for (int round = 0; round < 1500; ++round) {
    const auto anywhere = [&] { return random.in_box({-1, -1, 0.2}, {1, 1, 1.9}); };
    const LitScene lit(SceneMaker().square_light().polygon({anywhere(), anywhere(), anywhere()}));
    const SwathCuts cuts(lit.scene, lit.opaque, lit.emitter_scene);
    SightCaster caster(lit.scene, lit.opaque);
    const Swath swath = test::random_swath(random);
    const PlaneFrame& emitter = lit.emitter_scene.frame;
    const std::vector<double> limits = cuts.limits(swath);
    for (std::size_t k = 1; k < limits.size(); ++k) {
      const double t0 = limits[k - 1], t1 = limits[k], t = t0 + random(0, 1) * (t1 - t0);
      const auto line = line_at(swath, emitter, t);
      if (!line || t1 - t0 < 1e-3) continue;
      caster.cast(*line);
      if (caster.blockers().empty()) continue;
      const int triangle = caster.blockers().front();
      const auto is_hidden = [&](double at) {
        const auto other = line_at(swath, emitter, at);
        if (!other) return false;
        caster.cast(*other);
        return std::count(caster.blockers().begin(), caster.blockers().end(), triangle) > 0;
      };
      const SwathCuts::Stretch hidden = cuts.hidden_by(triangle, swath, t, t0, t1);
      EXPECT_LE(hidden.from, t);
      EXPECT_GE(hidden.to, t);
      if (hidden.length() < 1e-3) continue;
      for (const double share : {0.01, 0.2, 0.5, 0.8, 0.99})
        EXPECT_TRUE(is_hidden(hidden.from + share * hidden.length())) << round;
      ++found;
      whole += hidden.from == t0 && hidden.to == t1;
      if (hidden.from > t0 + 1e-3) ended += !is_hidden(hidden.from - 1e-4);
      if (hidden.to < t1 - 1e-3) ended += !is_hidden(hidden.to + 1e-4);
    }
  }
  EXPECT_GT(found, 200);
  EXPECT_GT(whole, 20);
  EXPECT_GT(ended, 100) << "stretches are as long as they can be";
}

TEST(SwathCuts, NothingInTheEmittersPlaneHidesAStretch) {
  const LitScene lit(SceneMaker().square_light().polygon({{-1, 0, 2}, {1, 0, 2}, {0, 0.1, 0.5}}));
  const SwathCuts cuts(lit.scene, lit.opaque, lit.emitter_scene);
  for (int t = 0; t < static_cast<int>(lit.opaque.topology().triangles.size()); ++t)
    EXPECT_EQ(cuts.hidden_by(t, fan(), 0.5, 0, 1).length(), 0);
}

TEST(SwathCuts, BetweenTwoLimitsAllLinesExistOrNone) {
  const LitScene lit(test::three_skew_slats());
  const SwathCuts cuts(lit.scene, lit.opaque, lit.emitter_scene);
  const auto count = static_cast<int>(lit.emitter_scene.edges.size());
  int swaths = 0;
  const auto check = [&](const Swath& swath) {
    ++swaths;
    const std::vector<double> limits = cuts.limits(swath);
    EXPECT_TRUE(std::is_sorted(limits.begin(), limits.end()));
    EXPECT_EQ(limits.front(), 0);
    EXPECT_EQ(limits.back(), 1);
    for (std::size_t k = 1; k < limits.size(); ++k) {
      const double t0 = limits[k - 1], t1 = limits[k];
      if (t1 - t0 < 1e-6) continue;
      const auto exists = [&](double share) {
        return line_at(swath, lit.emitter_scene.frame, t0 + share * (t1 - t0)).has_value();
      };
      for (const double share : {0.1, 0.3, 0.7, 0.9}) EXPECT_EQ(exists(share), exists(0.5));
    }
  };
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      for (int c = b + 1; c < count; ++c) triple_swath(lit.emitter_scene, a, b, c, check);
  EXPECT_GT(swaths, 0);
}

}  // namespace
}  // namespace halfshade
