#include "solver/adapt/fresh_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace halfshade {
namespace {

/// Two triangles of a unit square whose polynomials are 0.
std::vector<NoisyElement> square_of_two() {
  std::vector<NoisyElement> elements(2);
  elements[0].triangle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)};
  elements[1].triangle = {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  for (NoisyElement& element : elements) {
    element.normal = {0, 0, 1};
    element.area = 0.5;
    element.reach = 1;
  }
  return elements;
}

double wave(const Vec3& p) { return std::sin(7 * p.x()) + p.y(); }

std::vector<NoisyValue> waves_at(const FreshPlaces& places) {
  std::vector<NoisyValue> values;
  for (const FieldPoint& point : places.points)
    values.push_back(
        {Rgb::Constant(wave(point.point.position)), Rgb::Constant(wave(point.point.position))});
  return values;
}

/// ∫ wave², times three channels.
double exact_square() {
  // ∫ sin² 7x = 1/2 − sin 14/28, ∫ sin 7x = (1 − cos 7)/7, ∫ y² = 1/3, ∫ y = 1/2.
  return 3 * (0.5 - std::sin(14.) / 28 + (1 - std::cos(7.)) / 7 + 1. / 3);
}

TEST(FreshPlaces, TellTheSquareOfTheErrorInTheMean) {
  // The error is thought to be in one of them: it need not be.
  for (const double known : {0., 1., 100.}) {
    double sum = 0, squares = 0, variance = 0;
    constexpr int draws = 40;
    for (int draw = 0; draw < draws; ++draw) {
      std::vector<NoisyElement> elements = square_of_two();
      for (NoisyElement& element : elements) element.samples.resize(at(500 * draw));
      elements[1].surely_left = known;
      SquareError error;
      const FreshPlaces places =
          fresh_places(elements, {}, 1, 500, static_cast<std::uint64_t>(draw));
      EXPECT_NEAR(static_cast<double>(places.points.size()), 500, 3);
      error.add(places, waves_at(places), elements);
      sum += error.mean();
      squares += error.mean() * error.mean();
      variance += error.deviation() * error.deviation();
    }
    const double mean = sum / draws, spread = std::sqrt(squares / draws - mean * mean);
    const double claimed = std::sqrt(variance / draws);
    EXPECT_NEAR(mean, exact_square(), 4 * claimed / std::sqrt(draws)) << known;
    EXPECT_LT(spread, 1.5 * claimed) << known;
  }
}

TEST(FreshPlaces, MoreOfThemTellItBetter) {
  std::vector<NoisyElement> elements = square_of_two();
  SquareError error;
  double first = 0;
  for (std::uint64_t draw = 0; draw < 4; ++draw) {
    const FreshPlaces places = fresh_places(elements, {}, 1, 500, draw);
    error.add(places, waves_at(places), elements);
    if (draw == 0) first = error.deviation();
  }
  EXPECT_EQ(error.count(), 4);
  EXPECT_NEAR(error.deviation(), first / 2, 0.05 * first);
  EXPECT_NEAR(error.mean(), exact_square(), 4 * error.deviation());
  EXPECT_NEAR(static_cast<double>(elements[0].samples.size() + elements[1].samples.size()), 2000,
              8);
}

TEST(FreshPlaces, LieOnElementsThatCountOrMayHaveLight) {
  std::vector<NoisyElement> elements = square_of_two();
  elements[1].surface = 1;
  elements[1].reach = 0;
  AdaptiveFieldOptions options;
  options.counted = {true, false};
  EXPECT_EQ(fresh_places(elements, options, 1, 100, 0).element, std::vector<std::size_t>(100, 0));
  elements[0].reach = 0;
  options.counted = {false, false};
  EXPECT_TRUE(fresh_places(elements, options, 1, 100, 0).points.empty());
}

}  // namespace
}  // namespace halfshade
