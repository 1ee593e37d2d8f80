#include "meshing/geometry/cosine_direction.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(CosineDirection, HasTheMomentsOfACosine) {
  const PlaneFrame frame = make_frame(Vec3(1, 2, 3), Vec3(1, -2, 2) / 3);
  constexpr int n = 200;
  double cosines = 0, squares = 0;
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const Vec3 way = cosine_direction(frame, (i + .5) / n, (k + .5) / n);
      EXPECT_NEAR(way.norm(), 1, 1e-14);
      const double cosine = way.dot(frame.normal);
      cosines += cosine / (n * n);
      squares += cosine * cosine / (n * n);
      sum += way / (n * n);
    }
  // ∫ cos^k · cos / π over the hemisphere is 2 / (k + 2).
  EXPECT_NEAR(cosines, 2. / 3, 1e-4);
  EXPECT_NEAR(squares, 0.5, 1e-4);
  EXPECT_NEAR((sum - cosines * frame.normal).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace halfshade
