#include "meshing/geometry/lines_through.h"

#include "tests/support/line_hits_box.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

using test::Random;

Bounds random_box(Random& random, double size) {
  const Vec3 low = random.point(-1, 1);
  return {low, low + random.in_box(Vec3::Zero(), Vec3::Constant(size))};
}

Vec3 point_in(Random& random, const Bounds& box) { return random.in_box(box.low, box.high); }

TEST(LinesThrough, MayMeetWhateverOneOfThemHits) {
  Random random(3);
  int hit = 0, excluded = 0;
  for (int round = 0; round < 3000; ++round) {
    const Bounds a = random_box(random, 0.4), b = random_box(random, 0.4);
    const LinesThrough lines(a, b);
    // Before, between and behind the two.
    Bounds box = random_box(random, 0.3);
    if (round % 2 == 0) {
      const Vec3 on_line =
          point_in(random, a) + random(-2, 3) * (point_in(random, b) - point_in(random, a));
      box = Bounds{on_line, on_line}.grown(random(0, 0.1));
    }
    bool is_hit = false;
    for (int k = 0; k < 200 && !is_hit; ++k)
      is_hit = test::line_hits_box(point_in(random, a), point_in(random, b), box);
    EXPECT_TRUE(lines.may_meet(box, 1e-12) || !is_hit) << round;
    EXPECT_EQ(LinesThrough(b, a).may_meet(box, 1e-12), lines.may_meet(box, 1e-12));
    hit += is_hit;
    excluded += !lines.may_meet(box, 1e-12);
  }
  EXPECT_GT(hit, 500);
  EXPECT_GT(excluded, 500);
}

TEST(LinesThrough, OfTwoPointsMeetsNothingBesideTheirLine) {
  Random random(4);
  for (int round = 0; round < 500; ++round) {
    const Vec3 from = random.point(-1, 1), to = random.point(-1, 1);
    if ((to - from).norm() < 0.1) continue;
    const LinesThrough lines(bounds_of(from, from), bounds_of(to, to));
    const Vec3 on_line = from + random(-3, 3) * (to - from);
    const Vec3 beside = on_line + 1e-3 * (to - from).unitOrthogonal();
    EXPECT_TRUE(lines.may_meet(bounds_of(on_line, on_line), 1e-9));
    EXPECT_FALSE(lines.may_meet(bounds_of(beside, beside), 1e-9));
    EXPECT_TRUE(lines.may_meet(bounds_of(beside, beside), 1e-2)) << "so far it is grown";
  }
}

TEST(LinesThrough, OfBoxesThatMeetMayMeetAnything) {
  const LinesThrough lines({{0, 0, 0}, {1, 1, 1}}, {{0.5, 0.5, 1}, {2, 2, 2}});
  EXPECT_TRUE(lines.may_meet({{50, -70, 3}, {51, -69, 4}}, 0));
}

}  // namespace
}  // namespace halfshade
