#include "solver/adapt/unknown_trade.h"

#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Of that order, with layers that shrink by `shrinks` from degree to degree, and so on beyond.
FittedElement element_of(int order, double size, double shrinks) {
  FittedElement element;
  element.area = 1;
  element.fit.order = order;
  element.fit.coefficients = ChannelArray::Zero(basis_size(order), 3);
  for (int degree = 0; degree <= order + 1; ++degree)
    element.fit.layer[at(degree)] = size * std::pow(shrinks, degree);
  element.fit.error = element.fit.layer[at(order + 1)] / std::sqrt(1 - shrinks * shrinks);
  return element;
}

/// Square error with an order that is no higher than its own.
double square_error_with(const FittedElement& element, int order) {
  double square = element.fit.error * element.fit.error;
  for (int degree = order + 1; degree <= element.fit.order; ++degree)
    square += element.fit.layer[at(degree)] * element.fit.layer[at(degree)];
  return element.area * element.weight * square;
}

struct Sum {
  double square_error = 0;
  int unknowns = 0;
};

Sum sum_of(std::span<const FittedElement> elements) {
  Sum sum;
  for (const FittedElement& element : elements) {
    sum.square_error += element.square_error();
    sum.unknowns += basis_size(element.fit.order);
  }
  return sum;
}

TEST(UnknownTrade, NoOtherOrdersHaveFewerUnknownsForThatError) {
  test::Random random(3);
  for (int run = 0; run < 100; ++run) {
    constexpr int highest = 5;
    std::vector<FittedElement> elements(4);
    for (FittedElement& element : elements) {
      element = element_of(highest, 1, 0.5);
      element.area = std::pow(10, random(-3, 1));
      element.weight = random(0, 2);
      // Even and odd degrees may differ.
      for (double& layer : element.fit.layer) layer *= std::pow(10, random(-1, 1));
    }
    const std::vector<FittedElement> before = elements;
    const double most = std::pow(10, random(0, 3)) * sum_of(elements).square_error;
    drop_orders(elements, {}, most);
    const Sum after = sum_of(elements);
    EXPECT_LE(after.square_error, most);
    for (int k = 0; k < std::pow(highest + 1, 4); ++k) {
      Sum other;
      for (int e = 0, rest = k; e < 4; ++e, rest /= highest + 1) {
        other.square_error += square_error_with(before[at(e)], rest % (highest + 1));
        other.unknowns += basis_size(rest % (highest + 1));
      }
      if (other.square_error < (1 - 1e-9) * after.square_error) {
        EXPECT_GE(other.unknowns, after.unknowns) << run << ", " << k;
      }
    }
  }
}

TEST(UnknownTrade, WhatIsMoreThanAllowedLeavesOrdersAsTheyAre) {
  std::vector<FittedElement> elements(3, element_of(4, 1, 0.3));
  drop_orders(elements, {}, 0.5 * sum_of(elements).square_error);
  for (const FittedElement& element : elements) EXPECT_EQ(element.fit.order, 4);
}

/// Hundred elements that are better than they need be, and one that is not.
std::vector<FittedElement> uneven(double shrinks) {
  std::vector<FittedElement> elements(100, element_of(4, 1, 0.1));
  elements.push_back(element_of(4, 1, shrinks));
  return elements;
}

TEST(UnknownTrade, WhereOneKeepsAllFromHavingFewerItIsImproved) {
  const AdaptiveFieldOptions options;
  std::vector<FittedElement> elements = uneven(0.4);
  double most = 0.95 * sum_of(elements).square_error;
  std::vector<std::pair<int, int>> better = better_spread(elements, options, most);
  ASSERT_EQ(better.size(), 1U);
  EXPECT_EQ(better[0].first, 100);
  EXPECT_GT(better[0].second, 4);
  // What does not shrink is split: its order stays.
  elements = uneven(0.7);
  most = 0.95 * sum_of(elements).square_error;
  better = better_spread(elements, options, most);
  ASSERT_EQ(better.size(), 1U);
  EXPECT_EQ(better[0], std::pair(100, 4));
}

TEST(UnknownTrade, AlikeElementsHaveNothingToTrade) {
  const std::vector<FittedElement> elements(100, element_of(4, 1, 0.3));
  for (const double most : {0.5, 1.1, 2.})
    EXPECT_TRUE(better_spread(elements, {}, most * sum_of(elements).square_error).empty()) << most;
}

TEST(UnknownTrade, UnitsChangeNothing) {
  for (const double factor : {1e100, 3.7e-100}) {
    std::vector<FittedElement> elements, same;
    test::Random random(5);
    for (int e = 0; e < 50; ++e) {
      elements.push_back(element_of(random.integer(2, 6), random(0.5, 2), random(0.05, 0.9)));
      same.push_back(elements.back());
      same.back().area *= factor;
    }
    const double most = 1.5 * sum_of(elements).square_error;
    EXPECT_EQ(better_spread(elements, {}, most), better_spread(same, {}, factor * most));
    drop_orders(elements, {}, most);
    drop_orders(same, {}, factor * most);
    for (std::size_t e = 0; e < elements.size(); ++e)
      EXPECT_EQ(elements[e].fit.order, same[e].fit.order) << e;
  }
}

}  // namespace
}  // namespace halfshade
