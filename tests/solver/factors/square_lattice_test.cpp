#include "solver/factors/square_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace halfshade {
namespace {

/// Up to 8,192 places.
std::vector<SquareLattice> smaller_lattices() {
  std::vector<SquareLattice> lattices;
  for (std::size_t level = 0; level < 10; ++level) lattices.push_back(square_lattice(level));
  return lattices;
}

using Function = std::function<double(const Vec2&)>;

double mean(const SquareLattice& lattice, const Function& f) {
  double sum = 0;
  for (const Vec2& p : lattice.places) sum += f(p);
  return sum / static_cast<double>(lattice.places.size());
}

double residual(const SquareLattice& lattice, const SquareLattice::Watch& watch, const Vec2& place,
                const Function& f) {
  double value = f(place);
  for (std::size_t k = 0; k < SquareLattice::Watch::count; ++k)
    value -= watch.weight[k] * f(lattice.places[at(watch.near[k])]);
  return value;
}

TEST(SquareLattice, PointsLieInTheSquareAndApart) {
  std::size_t before = 0;
  for (const SquareLattice& lattice : smaller_lattices()) {
    const std::size_t count = lattice.places.size();
    EXPECT_GT(count, before);
    before = count;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_GE(lattice.places[i].minCoeff(), 0);
      EXPECT_LE(lattice.places[i].maxCoeff(), 1);
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_GT((lattice.places[i] - lattice.places[j]).norm(), 2 / static_cast<double>(count));
    }
  }
}

TEST(SquareLattice, EachBeginsWithTheOneBefore) {
  for (std::size_t level = 0; level + 1 < lattice_levels; ++level) {
    const auto &few = square_lattice(level).places, &many = square_lattice(level + 1).places;
    ASSERT_EQ(few.size(), places_of_lattice(level));
    ASSERT_EQ(many.size(), 2 * few.size());
    EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
  }
}

TEST(SquareLattice, WhatIsLinearIsExpectedFromItsNeighbours) {
  const Function f = [](const Vec2& p) { return 3 - 2 * p.x() + 5 * p.y(); };
  for (const SquareLattice& lattice : smaller_lattices()) {
    for (std::size_t k = 0; k < lattice.places.size(); ++k) {
      EXPECT_NEAR(residual(lattice, lattice.inner[k], lattice.places[k], f), 0, 1e-12);
      const auto& near = lattice.inner[k].near;
      EXPECT_EQ(std::count(near.begin(), near.end(), static_cast<int>(k)), 0);
    }
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(residual(lattice, lattice.corners[k], lattice.corner(k), f), 0, 1e-12);
  }
}

/// Root mean square of what means of kinks in all directions are off by.
double error_of_kinks(const std::vector<Vec2>& places) {
  double square = 0;
  int count = 0;
  for (double angle = 0.05; angle < 1.57; angle += 0.1)
    for (double c = 0.1; c < 1; c += 0.1, ++count) {
      // a x + b y − d, where that is positive: half of a square's first moment, or what corners
      // leave of it.
      const double a = std::cos(angle), b = std::sin(angle), d = c * (a + b);
      const auto cube = [](double x) { return x > 0 ? x * x * x : 0; };
      const double exact = (cube(a + b - d) - cube(a - d) - cube(b - d) + cube(-d)) / (6 * a * b);
      double mean = 0;
      for (const Vec2& p : places)
        mean += std::max(0., a * p.x() + b * p.y() - d) / static_cast<double>(places.size());
      square += (mean - exact) * (mean - exact);
    }
  return std::sqrt(square / count);
}

/// Less than those of Fibonacci lattices between them, as if these had as many points.
TEST(SquareLattice, KinksAreLessOffThanByFibonacciLattices) {
  const auto folded = [](double x) { return 1 - std::abs(2 * (x - std::floor(x)) - 1); };
  const auto scaled = [](const std::vector<Vec2>& places) {
    return std::pow(static_cast<double>(places.size()), 1.5) * error_of_kinks(places);
  };
  constexpr std::array<int, 7> fibonacci = {13, 21, 34, 55, 89, 144, 233};
  double of_fibonacci = 0;
  for (std::size_t k = 1; k < fibonacci.size(); ++k) {
    std::vector<Vec2> places;
    for (int i = 0; i < fibonacci[k]; ++i)
      places.emplace_back(folded((i + .25) / fibonacci[k]),
                          folded((static_cast<double>(i) * fibonacci[k - 1] + .25) / fibonacci[k]));
    of_fibonacci += std::log(scaled(places)) / (fibonacci.size() - 1);
  }
  double mean = 0;
  for (std::size_t level = 0; level < 5; ++level)
    mean += std::log(scaled(square_lattice(level).places)) / 5;
  EXPECT_LT(mean, of_fibonacci - 0.2);
}

/// None of the larger ones falls back: Fibonacci lattices of 13 to 196,418 points reach 2.8.
TEST(SquareLattice, KinksAreAsLittleOffAtAllSizes) {
  for (std::size_t level = 0; level < lattice_levels; ++level) {
    const auto count = static_cast<double>(places_of_lattice(level));
    EXPECT_LT(error_of_kinks(square_lattice(level).places), 2 * std::pow(count, -1.5)) << count;
  }
}

/// Of a smooth function nearly like 1/N², of kinks, wherever they are, faster than 1/N.
TEST(SquareLattice, MeansConvergeInSpiteOfKinks) {
  const auto& coarse = square_lattice(0);
  const auto& fine = square_lattice(12);
  const double ratio =
      static_cast<double>(fine.places.size()) / static_cast<double>(coarse.places.size());
  const Function smooth = [](const Vec2& p) { return std::exp(p.x() - 2 * p.y()); };
  const double expected = (std::exp(1) - 1) * (1 - std::exp(-2)) / 2;
  EXPECT_LT(std::abs(mean(fine, smooth) - expected),
            2 * std::pow(ratio, -1.75) * std::abs(mean(coarse, smooth) - expected));
  double at_coarse = 0, at_fine = 0;
  for (double c = 0.1; c < 1; c += 0.05) {
    const Function kink = [&](const Vec2& p) { return std::max(0., p.x() - c); };
    const Function slanted = [&](const Vec2& p) { return std::max(0., p.x() + p.y() - 2 * c); };
    const double of_kink = (1 - c) * (1 - c) / 2;
    const double d = 2 * c, of_slanted = d < 1 ? 1 - d + d * d * d / 6 : std::pow(2 - d, 3) / 6;
    at_coarse +=
        std::pow(mean(coarse, kink) - of_kink, 2) + std::pow(mean(coarse, slanted) - of_slanted, 2);
    at_fine +=
        std::pow(mean(fine, kink) - of_kink, 2) + std::pow(mean(fine, slanted) - of_slanted, 2);
  }
  EXPECT_LT(std::sqrt(at_fine), std::pow(ratio, -1.25) * std::sqrt(at_coarse));
}

}  // namespace
}  // namespace halfshade
