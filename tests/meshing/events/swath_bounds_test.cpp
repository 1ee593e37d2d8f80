#include "meshing/events/swath.h"
#include "tests/support/line_hits_box.h"
#include "tests/support/random_swaths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

// What may be passed over, against samples of the lines.

namespace halfshade {
namespace {

using test::emitter;
using test::Random;
using test::random_swath;

TEST(SwathBounds, NeverExcludesABoxThatALineHits) {
  Random random(8);
  int hit = 0, excluded = 0;
  for (int round = 0; round < 1500; ++round) {
    const Swath swath = random_swath(random);
    std::vector<double> limits = {0, 1};
    own_limits(swath, limits);
    std::sort(limits.begin(), limits.end());
    const auto k = static_cast<std::size_t>(random.integer(1, static_cast<int>(limits.size()) - 1));
    const double width = limits[k] - limits[k - 1], from = random(0, 1), to = random(from, 1);
    const double t0 = limits[k - 1] + from * width, t1 = limits[k - 1] + to * width;
    if (!line_at(swath, emitter, 0.5 * (t0 + t1))) continue;
    const SwathBounds bounds = bounds_of(swath, t0, t1);
    for (int box = 0; box < 10; ++box) {
      Vec3 low = random.in_box({-2, -2, -1}, {2, 2, 2});
      if (box % 2 == 0) {  // near one of its lines
        const auto line = line_at(swath, emitter, t0 + random(0, 1) * (t1 - t0));
        if (line) low = line->start + random(-0.5, 3) * line->direction;
      }
      const Vec3 high = low + random.in_box({0.01, 0.01, 0.01}, {0.5, 0.5, 0.5});
      low -= random.in_box({0, 0, 0}, {0.1, 0.1, 0.1});
      bool is_hit = false;
      for (int i = 0; i <= 50; ++i)
        if (const auto line = line_at(swath, emitter, t0 + 0.02 * i * (t1 - t0)))
          is_hit = is_hit ||
                   test::line_hits_box(line->start, line->start + line->direction, {low, high});
      const bool meets = bounds.may_meet({low, high}, 1e-12);
      EXPECT_TRUE(meets || !is_hit) << round;
      hit += is_hit;
      excluded += !meets;
    }
  }
  EXPECT_GT(hit, 1500);
  EXPECT_GT(excluded, 3000) << "bounds that exclude nothing are of no use";
}

TEST(SwathBounds, OfOneLineHoldsWhatLiesOnItAndNothingElse) {
  Random random(11);
  int compared = 0;
  for (int round = 0; round < 500; ++round) {
    const Swath swath = random_swath(random);
    const double t = random(0, 1);
    const auto line = line_at(swath, emitter, t);
    if (!line || std::abs(line->direction.z()) < 0.2) continue;
    const SwathBounds bounds = bounds_of(swath, t, t);
    if ((bounds.lines.near().centre() - bounds.lines.far().centre()).norm() < 0.1) continue;
    const Vec3 size = Vec3::Constant(1e-6), across = line->direction.unitOrthogonal();
    for (int k = 0; k < 5; ++k) {
      const Vec3 p = line->start + random(0, 2) * line->direction;
      EXPECT_TRUE(bounds.may_meet({p - size, p + size}, 1e-9)) << round;
      const Vec3 beside = p + 1e-3 * across;
      EXPECT_FALSE(bounds.may_meet({beside - size, beside + size}, 1e-9)) << round;
    }
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

TEST(SwathBounds, SlackLetsItReachFarther) {
  Swath swath;
  swath.apex = {0, 0, 2};
  swath.base = {{1, -1, 1}, {1, 1, 1}};  // in the plane x + z = 2
  const SwathBounds bounds = bounds_of(swath, 0, 1);
  EXPECT_NEAR(std::abs(bounds.normal.dot(Vec3(1, 0, 1).normalized())), 1, 1e-14);
  const Vec3 low(0.6, -0.1, 1.5), high(0.7, 0.1, 1.6);  // from that plane 0.1/√2
  EXPECT_FALSE(bounds.may_meet({low, high}, 0.0707));
  EXPECT_TRUE(bounds.may_meet({low, high}, 0.0708));
}

}  // namespace
}  // namespace halfshade
