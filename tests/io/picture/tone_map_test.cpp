#include "io/picture/tone_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace halfshade {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double exposure(const std::vector<Rgb>& values, std::vector<std::uint8_t> emits = {}) {
  emits.resize(values.size(), 0);
  return choose_exposure(values, std::vector<double>(values.size(), 1.0), emits);
}

TEST(ToneMap, IsProportionalBelowTheShoulder) {
  const Rgb value(0.5, 0.25, 0.125);
  EXPECT_TRUE(tone_map(value, 1.0).isApprox(value, 1e-15));
  EXPECT_TRUE(tone_map(value, 0.5).isApprox(value / 2, 1e-15));
  EXPECT_TRUE((tone_map(Rgb::Zero(), 1.0) == 0).all());
}

TEST(ToneMap, RisesSteadilyToWhite) {
  double last = -1;
  for (double v = 0; v < 100; v += 0.01) {
    const Rgb mapped = tone_map(Rgb(v, v / 2, 0), 1);
    EXPECT_GT(mapped[0], last - 1e-15);
    EXPECT_LE(mapped[0], 1);
    EXPECT_GE(mapped[0], mapped[1]);
    EXPECT_GE(mapped[1], mapped[2]);
    last = mapped[0];
  }
  EXPECT_GT(tone_map(Rgb(100, 50, 20), 1).minCoeff(), 0.99) << "a lamp is white";
}

TEST(ToneMap, KeepsTheRatiosOfTheChannelsUpToWhite) {
  for (const double v : {0.3, 0.7, 0.95}) {
    const Rgb mapped = tone_map(Rgb(v, v / 2, v / 4), 1);
    EXPECT_NEAR(mapped[1] / mapped[0], 0.5, 1e-12);
    EXPECT_NEAR(mapped[2] / mapped[0], 0.25, 1e-12);
  }
}

TEST(ToneMap, HasNoKink) {
  // Slopes on both sides of any value agree to the step's order.
  constexpr double step = 1e-4;
  const auto f = [](double v) { return tone_map(Rgb::Constant(v), 1)[0]; };
  for (double v = 0.4; v < 1.5; v += 0.01)
    EXPECT_NEAR((f(v + step) - f(v)) / step, (f(v) - f(v - step)) / step, 10 * step) << v;
}

TEST(ToneMap, AnythingComesOutBetweenBlackAndWhite) {
  const double odd[] = {nan, infinity, -infinity, -1, 0, 1e-320, 1e300, 0.5};
  for (const double a : odd)
    for (const double b : odd)
      for (const double factor : {0.0, 1.0, 1e300, infinity, nan}) {
        const Rgb mapped = tone_map(Rgb(a, b, 0.3), factor);
        EXPECT_TRUE((mapped >= 0).all() && (mapped <= 1).all()) << a << ' ' << b << ' ' << factor;
      }
}

TEST(EncodeSrgb, MatchesTheStandardsTable) {
  // Linear values of sRGB codes: ((c/255 + 0.055)/1.055)^2.4, and c/255/12.92 for small ones.
  EXPECT_EQ(encode_srgb(Rgb(0, 1, 0.2158605)), (std::array<std::uint8_t, 3>{0, 255, 128}));
  EXPECT_EQ(encode_srgb(Rgb(0.0003035, 0.5028865, 0.0512695)),
            (std::array<std::uint8_t, 3>{1, 188, 64}));
  EXPECT_EQ(encode_srgb(Rgb(-1, 2, nan)), (std::array<std::uint8_t, 3>{0, 255, 0}));
}

TEST(Exposure, AUniformSceneComesOutAtTheBrightLevel) {
  EXPECT_NEAR(exposure(std::vector<Rgb>(100, Rgb(2, 4, 1))) * 4, 0.8, 1e-12);
}

TEST(Exposure, IsThePercentileOfTheBrightestChannelByWeight) {
  // Values 1…100 with weights that put 95 % on those up to 50.
  std::vector<Rgb> values;
  std::vector<double> weights;
  for (int i = 1; i <= 100; ++i) {
    values.emplace_back(i / 2.0, i, 0);
    weights.push_back(i <= 50 ? 0.95001 / 50 : 0.04999 / 50);
  }
  EXPECT_NEAR(0.8 / choose_exposure(values, weights, std::vector<std::uint8_t>(100, 0)), 50, 1e-9);
}

TEST(Exposure, ScalesInverselyOverTheWholeRangeOfDoubles) {
  const std::vector<Rgb> values = {{1, 2, 3}, {0.1, 0.2, 0.3}, {5, 4, 3}};
  const double reference = exposure(values);
  for (const double factor : {1e-250, 1e-3, 7.0, 1e250}) {
    std::vector<Rgb> scaled;
    for (const Rgb& value : values) scaled.emplace_back(factor * value);
    EXPECT_NEAR(exposure(scaled) * factor / reference, 1, 1e-12) << factor;
  }
}

TEST(Exposure, LampsDoNotCount) {
  std::vector<Rgb> values(10, Rgb::Constant(2));
  const double without = exposure(values);
  std::vector<std::uint8_t> emits(10, 0);
  values.insert(values.end(), 90, Rgb::Constant(1000));
  emits.resize(100, 1);
  EXPECT_EQ(exposure(values, emits), without);
  // Where only lamps are to be seen, they are what is looked at.
  EXPECT_NEAR(exposure({Rgb::Constant(5), Rgb::Zero()}, {1, 0}) * 5, 0.8, 1e-12);
}

TEST(Exposure, ASmallLitSpotInTheDarkIsNotBlownUpWithoutEnd) {
  std::vector<Rgb> values(1000, Rgb::Zero());
  values[500] = Rgb::Constant(3);
  EXPECT_NEAR(exposure(values) * 3, 4 * 0.8, 1e-12);
}

TEST(Exposure, NoLightGivesOne) {
  EXPECT_EQ(exposure({}), 1);
  EXPECT_EQ(exposure(std::vector<Rgb>(3, Rgb::Zero())), 1);
  EXPECT_EQ(exposure({Rgb::Constant(nan), Rgb(infinity, 1, 1)}), 1);
}

}  // namespace
}  // namespace halfshade
