#include "solver/factors/finished_matrix.h"

#include "tests/support/scene_maker.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// Two unit squares that are said to see .2 of each other, of which the first is short by so much
/// of the rest.
RowExchange exchange_that_misses(double missing) {
  RowExchange exchange(2);
  exchange.add(0, 1, .2, .0005);
  exchange.add(0, surroundings, .8 - missing, .0006);
  exchange.add(1, surroundings, .8, .0006);
  exchange.report.method = FactorMethod::exact;
  exchange.report.is_complete = true;
  return exchange;
}

Eigen::ArrayXd errors_of(double missing) {
  test::SceneMaker maker;
  maker.up({0, 0}, {1, 1}, 0).down({0, 0}, {1, 1}, 1);
  const FactorScene scene = make_factor_scene(maker.scene, FactorUnit::face);
  return finished_matrix(scene, exchange_that_misses(missing), .001, {}).error;
}

TEST(FinishedMatrix, WhatASumMissesMayBeInOneEntry) {
  EXPECT_NEAR(errors_of(0)[0], .0005, 1e-9) << "no more than the other entry";
  EXPECT_NEAR(errors_of(.0009)[0], .0009, 1e-9) << "more than either claims";
  EXPECT_NEAR(errors_of(.0009)[1], .0005, 1e-9) << "the other row is whole";
  EXPECT_GT(errors_of(.0015)[0], .0015) << "more than both claim";
}

}  // namespace
}  // namespace halfshade
