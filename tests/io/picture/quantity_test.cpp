#include "io/picture/result_file.h"
#include "io/write/write_result.h"
#include "tests/support/files.h"
#include "tests/support/sample_result.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// A result that was written and read.
class QuantityOf : public testing::Test {
 protected:
  ResultFile read(const SolveResult& result) const {
    write_result(result, {}, folder_.path() / "a.vtu");
    return read_result(folder_.path() / "a.vtu");
  }
  const SolveResult result_ = test::sample_result(3);
  const test::TempDir folder_;
  const ResultFile file_ = read(result_);
};

TEST_F(QuantityOf, ALightIsTheMeanOfItsChannelsOrOneOfThem) {
  for (const auto& [channel, c, name] :
       {std::tuple{"mean", -1, "mean of R, G, B"}, {"R", 0, "R"}, {"B", 2, "B"}, {"1", 1, "G"}}) {
    const ValueMesh values = quantity_of(file_, "irradiance", channel);
    EXPECT_EQ(values.quantity.channel, name);
    EXPECT_EQ(values.quantity.unit, "W/m²");
    EXPECT_FALSE(values.quantity.is_whole);
    ASSERT_EQ(values.mesh.triangle_value.size(), 18U);
    EXPECT_EQ(values.mesh.point_value.size(), values.mesh.points.size());
    for (Eigen::Index e = 0; e < 18; ++e) {
      const auto row = result_.solution.irradiance.row(e);
      EXPECT_NEAR(values.mesh.triangle_value[static_cast<std::size_t>(e)][1],
                  c < 0 ? row.mean() : row[c], 1e-15);
    }
  }
}

TEST_F(QuantityOf, WhatOnlyCellsHaveIsFlat) {
  const ValueMesh error = quantity_of(file_, "error_estimate");
  EXPECT_TRUE(error.mesh.point_value.empty());
  EXPECT_EQ(error.mesh.triangle_value[13][0], 1);
  EXPECT_EQ(error.quantity.channel, "");
  EXPECT_EQ(error.mesh.emits[0], 1) << "the first element emits";
  EXPECT_EQ(error.mesh.emits[1], 0);
  const ValueMesh region = quantity_of(file_, "region");
  EXPECT_TRUE(region.quantity.is_whole);
  EXPECT_EQ(region.quantity.unit, "");
  EXPECT_EQ(region.mesh.triangle_value[6][0], 2);
}

TEST_F(QuantityOf, AnUnknownNameIsAnsweredWithThoseThereAre) {
  test::expect_error([&] { quantity_of(file_, "colour"); }, ErrorCode::usage,
                     {"'colour'", "radiosity, irradiance, direct_irradiance", "region"});
}

TEST_F(QuantityOf, AnUnknownChannelIsAnsweredWithThoseThereAre) {
  test::expect_error([&] { quantity_of(file_, "irradiance", "green"); }, ErrorCode::usage,
                     {"'green'", "'irradiance'", "0 to 2", "R, G, B and mean"});
  test::expect_error([&] { quantity_of(file_, "irradiance", "3"); }, ErrorCode::usage, {"'3'"});
  test::expect_error([&] { quantity_of(file_, "order", "R"); }, ErrorCode::usage, {"0 only"});
}

TEST_F(QuantityOf, CodesOfSeveralEmittersHaveNoMean) {
  SolveResult result = result_;
  result.emitters = {{0, 1.}, {0, 2.}};
  for (int k = 0; k < 36; ++k) result.regions.push_back(static_cast<Region>(k % 3));
  const ResultFile file = read(result);
  test::expect_error([&] { quantity_of(file, "regions"); }, ErrorCode::usage,
                     {"'mean'", "'regions'", "0 to 1"});
  const ValueMesh second = quantity_of(file, "regions", "1");
  EXPECT_EQ(second.mesh.triangle_value[0][0], 1);
  EXPECT_EQ(second.mesh.triangle_value[1][0], 0);
  EXPECT_EQ(second.quantity.channel, "component 1");
}

}  // namespace
}  // namespace halfshade
