#include "solver/direct/direct_light.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <optional>

namespace halfshade {
namespace {

using test::Random;

/// Differences of form factors, which know nothing of edges and how they move. Extrapolated twice
/// (Richardson), so that the error is of the sixth order in the step.
class Differences {
 public:
  Differences(const DirectLightIndex& index, int emitter, const SurfacePoint& at, double step)
      : index_(index), emitter_(emitter), at_(at), step_(step) {
    signature_ = index.factor(at, emitter).signature;
  }

  double first(int i) {
    return extrapolated([&](double h) {
      const Vec3 d = h * Vec3::Unit(i);
      return (value(d) - value(-d)) / (2 * h);
    });
  }

  double second(int i, int j) {
    return extrapolated([&](double h) {
      const Vec3 a = h * Vec3::Unit(i), b = h * Vec3::Unit(j);
      if (i == j) return (value(a) - 2 * value(Vec3::Zero()) + value(-a)) / (h * h);
      return (value(a + b) - value(a - b) - value(b - a) + value(-a - b)) / (4 * h * h);
    });
  }

  /// Whether all points were in one cell of the discontinuity mesh.
  bool in_one_cell() const { return in_one_cell_; }

 private:
  template <class F>
  double extrapolated(F f) {
    const double a = f(step_), b = f(step_ / 2), c = f(step_ / 4);
    const double ab = (4 * b - a) / 3, bc = (4 * c - b) / 3;
    return (16 * bc - ab) / 15;
  }

  double value(const Vec3& offset) {
    const PointFactor factor = index_.factor({at_.position + offset, at_.normal}, emitter_);
    in_one_cell_ = in_one_cell_ && factor.signature == signature_;
    return factor.visible;
  }

  const DirectLightIndex& index_;
  int emitter_;
  SurfacePoint at_;
  double step_;
  std::uint64_t signature_ = 0;
  bool in_one_cell_ = true;
};

/// Compares at random points and returns how many could be compared.
int compare(const SoundScene& scene, Random& random, int points, double tilt) {
  const DirectLightIndex index(scene);
  int compared = 0;
  for (int k = 0; k < points; ++k) {
    const SurfacePoint point{random.in_box({-2, -2, 0}, {2, 2, 0.4}),
                             (Vec3::UnitZ() + tilt * random.direction()).normalized()};
    const PointFactorDerivatives got = index.factor_derivatives(point, 0);
    EXPECT_EQ(got.factor.visible, index.factor(point, 0).visible);
    if (got.factor.region != Region::penumbra && got.factor.region != Region::lit) {
      EXPECT_TRUE(got.gradient.isZero(0) && got.hessian.isZero(0));
      continue;
    }
    Differences differences(index, 0, point, 1e-3);
    Vec3 gradient;
    Eigen::Matrix3d hessian;
    for (int i = 0; i < 3; ++i) {
      gradient[i] = differences.first(i);
      for (int j = 0; j < 3; ++j) hessian(i, j) = differences.second(i, j);
    }
    if (!differences.in_one_cell()) continue;
    ++compared;
    const std::string where = testing::PrintToString(point.position.transpose());
    EXPECT_LT((got.gradient - gradient).norm(), 1e-6 * std::max(1., gradient.norm())) << where;
    EXPECT_LT((got.hessian - hessian).norm(), 1e-6 * std::max(1., hessian.norm()))
        << where << "\n"
        << got.hessian << "\n\n"
        << hessian;
    EXPECT_LT((got.hessian - got.hessian.transpose()).norm(), 1e-10 * (1 + got.hessian.norm()));
  }
  return compared;
}

void add_light(SoundScene& scene) {
  test::add_surface(scene, {{{-1, -1, 2.5}, {-1, 1, 2.5}, {1, 1, 2.5}, {1, -1, 2.5}}}, 1);
}

TEST(DirectLightDerivatives, OfAnUnobstructedLight) {
  SoundScene scene = test::empty_sound_scene(6);
  add_light(scene);
  Random random(1);
  EXPECT_EQ(compare(scene, random, 50, 0), 50);
}

TEST(DirectLightDerivatives, OfALightCutByTheHorizon) {
  SoundScene scene = test::empty_sound_scene(6);
  add_light(scene);
  Random random(2);
  EXPECT_GT(compare(scene, random, 100, 2), 50);
}

TEST(DirectLightDerivatives, OfApparentVerticesOfManyOccluders) {
  for (const std::uint64_t seed : {3u, 4u, 5u, 6u}) {
    Random random(seed);
    SoundScene scene = test::empty_sound_scene(6);
    add_light(scene);
    for (int k = 0; k < 5; ++k)
      test::add_surface(
          scene,
          {test::random_polygon(random, random.in_box({-1.2, -1.2, 0.8}, {1.2, 1.2, 2}),
                                random.direction(), random(0.2, 0.6))},
          0);
    EXPECT_GT(compare(scene, random, 60, 0.5), 20);
  }
}

TEST(DirectLightDerivatives, OfClosedBodies) {
  Random random(7);
  SoundScene scene = test::empty_sound_scene(6);
  add_light(scene);
  for (int k = 0; k < 3; ++k)
    for (const auto& face :
         test::random_box(random, random.in_box({-1, -1, 0.8}, {1, 1, 1.8}), 0.4))
      test::add_surface(scene, {face}, 0);
  EXPECT_GT(compare(scene, random, 100, 0.5), 30);
}

TEST(DirectLightDerivatives, MeetAtTheTabulatedJumpsOfS1) {
  // At x = 1.25 the first and second derivative along x jump by −2.494278e-2 and 7.332e-2.
  const DirectLightIndex index(test::s1());
  const double step = 1e-7;
  const auto inside = index.factor_derivatives({{1.25 - step, 0, 0}, Vec3::UnitZ()}, 0);
  const auto outside = index.factor_derivatives({{1.25 + step, 0, 0}, Vec3::UnitZ()}, 0);
  EXPECT_NEAR(outside.gradient.x() - inside.gradient.x(), -2.494278e-2, 5e-7);
  EXPECT_NEAR(outside.hessian(0, 0) - inside.hessian(0, 0), 7.332e-2, 1e-4);
  const auto umbra = index.factor_derivatives({{0.25 - step, 0.05, 0}, Vec3::UnitZ()}, 0);
  const auto penumbra = index.factor_derivatives({{0.25 + step, 0.05, 0}, Vec3::UnitZ()}, 0);
  EXPECT_NEAR(penumbra.gradient.x() - umbra.gradient.x(), 7.406901e-2, 5e-7);
  EXPECT_NEAR(penumbra.hessian(0, 0) - umbra.hessian(0, 0), 5.362e-2, 1e-4);
}

TEST(DirectLightDerivatives, MeetAtTheTabulatedJumpOfAnEdgeTripleEvent) {
  // The umbra boundary that two skew edges and an edge of the light make: f and f' are continuous,
  // f'' along x jumps by 1.339969e-2. The edges (0,0,1)+s(1,1,0) and (.1,0,.75)+s(1,−1,.1) bound
  // half-planes large enough to hide everything else.
  const Vec3 a(0, 0, 1), b(1, 1, 0), c(0.1, 0, 0.75), d(1, -1, 0.1);
  SoundScene scene = test::empty_sound_scene(6);
  test::add_surface(scene, {{{-0.5, -0.5, 2}, {-0.5, 0.5, 2}, {0.5, 0.5, 2}, {0.5, -0.5, 2}}}, 1);
  double jump = 0;
  // Which side of each edge is opaque is not tabulated; one of the four choices has the event.
  for (const double s1 : {-1., 1.})
    for (const double s2 : {-1., 1.}) {
      SoundScene both = scene;
      const Vec3 across1 = 8 * s1 * Vec3(1, -1, 0), across2 = 8 * s2 * Vec3(1, 1, 0);
      test::add_surface(both, {{a - 9 * b, a + 9 * b, a + 9 * b + across1, a - 9 * b + across1}},
                        0);
      test::add_surface(both, {{c - 5 * d, c + 5 * d, c + 5 * d + across2, c - 5 * d + across2}},
                        0);
      const DirectLightIndex index(both);
      const double step = 1e-6;
      const auto before = index.factor_derivatives({{0.1 - step, -0.3, 0}, Vec3::UnitZ()}, 0);
      const auto after = index.factor_derivatives({{0.1 + step, -0.3, 0}, Vec3::UnitZ()}, 0);
      EXPECT_NEAR(before.factor.visible, after.factor.visible, 1e-6);
      const double here = after.hessian(0, 0) - before.hessian(0, 0);
      if (std::abs(here) > std::abs(jump)) jump = here;
    }
  EXPECT_NEAR(std::abs(jump), 1.339969e-2, 1e-5);
}

}  // namespace
}  // namespace halfshade
