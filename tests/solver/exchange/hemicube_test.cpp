#include "solver/exchange/hemicube.h"

#include "solver/exchange/form_factor.h"
#include "tests/support/analytic.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.);
}

/// The closed form of a pixel of the hemicube's top.
double exact_top_pixel(const Vec3& direction, double size) {
  const Vec2 p = direction.head<2>() / direction.z();
  return test::point_parallel_rectangle(p.x() - size / 2, p.x() + size / 2, p.y() - size / 2,
                                        p.y() + size / 2, 1);
}

TEST(MakeHemicube, DeltaFactorsSumToOneUpToTheMidpointRule) {
  for (const auto& [pixels, excess] : {std::pair{50, 2.17e-4}, {100, 5.42e-5}, {200, 1.36e-5}}) {
    const Hemicube cube = make_hemicube(pixels);
    ASSERT_EQ(cube.factors.size(), static_cast<std::size_t>(3 * pixels * pixels));
    EXPECT_NEAR(sum_of(cube.factors) - 1, excess, 0.005 * excess) << pixels;
  }
}

TEST(MakeHemicube, TheTopHasItsClosedForm) {
  const double exact = test::point_parallel_rectangle(-1, 1, -1, 1, 1);
  EXPECT_NEAR(exact, 0.554126423980, 1e-12);
  double last = 0;
  for (const int pixels : {20, 40, 80}) {
    const Hemicube cube = make_hemicube(pixels);
    const auto top = static_cast<std::ptrdiff_t>(pixels) * pixels;
    const double error =
        std::abs(std::accumulate(cube.factors.begin(), cube.factors.begin() + top, 0.) - exact);
    if (last > 0) {
      EXPECT_NEAR(last / error, 4, 0.1) << "second order";
    }
    last = error;
  }
}

TEST(MakeHemicube, EachDeltaFactorIsItsPixelsClosedForm) {
  constexpr int pixels = 32;
  const Hemicube cube = make_hemicube(pixels);
  for (std::size_t k = 0; k < pixels * pixels; ++k)
    EXPECT_NEAR(cube.factors[k] / exact_top_pixel(cube.directions[k], 2. / pixels), 1, 2e-3);
  // Sides: the pixel as a polygon, its factor by Lambert's sum.
  for (std::size_t k = pixels * pixels; k < cube.factors.size(); ++k) {
    const Vec3 d = cube.directions[k];
    EXPECT_NEAR(d.norm(), 1, 1e-15);
    EXPECT_GT(d.z(), 0);
    const int axis = std::abs(d.x()) > std::abs(d.y()) ? 0 : 1;
    const Vec3 centre = d / std::abs(d[axis]);
    const Vec3 across = Vec3::Unit(1 - axis) / pixels, up = Vec3::UnitZ() / pixels;
    std::vector<Vec3> pixel = {centre - across - up, centre + across - up, centre + across + up,
                               centre - across + up};
    const double exact = std::abs(lambert_sum(Vec3::Zero(), Vec3::UnitZ(), pixel));
    EXPECT_NEAR(cube.factors[k] / exact, 1, 3e-3);
  }
}

TEST(MakeHemicube, AnOddOrTinyNumberOfPixelsIsRefused) {
  for (const int pixels : {0, -2, 1, 33})
    test::expect_error([&] { make_hemicube(pixels); }, ErrorCode::contract, {"even"});
}

/// Squares parallel to the plane z = 0, looking down on it or up.
struct Items {
  TriangleSoup soup;
  std::vector<Vec3> normals;

  void add_square(const Vec3& centre, double half, bool downwards) {
    const int p = static_cast<int>(soup.points.size());
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      soup.points.push_back(centre + half * Vec3(x, y, 0));
    for (std::array<int, 3> t : {std::array{p, p + 1, p + 2}, {p, p + 2, p + 3}}) {
      if (downwards) std::swap(t[1], t[2]);
      soup.triangles.push_back(t);
      soup.owner.push_back(static_cast<int>(normals.size()));
      soup.plane.push_back(static_cast<int>(normals.size()));
    }
    normals.push_back(Vec3::UnitZ() * (downwards ? -1 : 1));
  }
  std::vector<double> seen_from(const Vec3& point, int pixels, double turn = 0.3) const {
    std::vector<double> factors(normals.size(), 0);
    add_hemicube(make_hemicube(pixels),
                 {point, Vec3::UnitZ(), Vec3(std::cos(turn), std::sin(turn), 0)},
                 VisibilityIndex(soup), normals, factors);
    return factors;
  }
};

TEST(AddHemicube, FallsTowardsTheClosedFormWithItsPixels) {
  Items items;
  items.add_square({0.3, 0.1, 0.7}, 0.5, true);
  const double exact = test::point_parallel_rectangle(-0.2, 0.8, -0.4, 0.6, 0.7);
  // Mean over turns: a single cube may be right by luck.
  const auto error = [&](int pixels) {
    double squares = 0;
    for (int k = 0; k < 12; ++k)
      squares += std::pow(items.seen_from(Vec3::Zero(), pixels, 0.13 * k)[0] / exact - 1, 2);
    return std::sqrt(squares / 12);
  };
  const double coarse = error(8), middle = error(32), fine = error(128);
  EXPECT_GT(coarse, 2 * middle);
  EXPECT_GT(middle, 3 * fine);
  EXPECT_LT(fine, 2e-3);
  EXPECT_GT(coarse, 5e-3);
}

TEST(AddHemicube, AliasingSmallThingsAreMissedOrCountedWhole) {
  // A square a fifth of a pixel wide has the factor of a pixel, or none.
  constexpr int pixels = 32;
  constexpr double size = 2. / pixels;
  const double exact = test::point_parallel_rectangle(size / 10, size / 10, 1) * 4;
  Items hit, missed;
  hit.add_square({size / 2, size / 2, 1}, size / 10, true);
  missed.add_square({0, 0, 1}, size / 10, true);
  EXPECT_NEAR(hit.seen_from(Vec3::Zero(), pixels, 0)[0] / exact, 25, 0.2);
  EXPECT_EQ(missed.seen_from(Vec3::Zero(), pixels, 0)[0], 0);
}

TEST(AddHemicube, ProximityACentroidDoesNotSpeakForItsElement) {
  // Squares face each other across a gap of a fiftieth of their width, one moved aside by three
  // quarters: a quarter of each sees the other, but no centroid does.
  constexpr double gap = 0.02;
  const double exact =
      test::offset_parallel_rectangles({-0.5, 0.5}, {-0.5, 0.5}, {0.25, 1.25}, {-0.5, 0.5}, gap);
  EXPECT_GT(exact, 0.22);
  Items items;
  items.add_square({0.75, 0, gap}, 0.5, true);
  for (const int pixels : {64, 256})
    EXPECT_LT(items.seen_from(Vec3::Zero(), pixels)[0], 0.01) << "no number of pixels helps";
}

TEST(AddHemicube, WhatIsInFrontHidesWhatIsBehindAlsoByItsBack) {
  Items items;
  items.add_square({0, 0, 2}, 5, true);
  items.add_square({0, 0, 1}, 1, false);  // shows its back
  const std::vector<double> factors = items.seen_from(Vec3::Zero(), 64, 0);
  EXPECT_EQ(factors[1], 0);
  const double exact = test::point_parallel_rectangle(-2.5, 2.5, -2.5, 2.5, 1) -
                       test::point_parallel_rectangle(-1, 1, -1, 1, 1);
  EXPECT_NEAR(factors[0], exact, 5e-3);
}

TEST(AddHemicube, OfTwinsBackToBackTheFrontIsSeen) {
  Items items;
  items.add_square({0, 0, 1}, 1, false);
  items.add_square({0, 0, 1}, 1, true);
  const std::vector<double> factors = items.seen_from(Vec3::Zero(), 32, 0);
  EXPECT_EQ(factors[0], 0);
  EXPECT_NEAR(factors[1], 0.554126423980, 1e-3);
}

}  // namespace
}  // namespace halfshade
