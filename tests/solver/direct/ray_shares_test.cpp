#include "solver/direct/ray_shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

std::vector<RayShare> of_strengths(const std::vector<double>& strengths) {
  std::vector<RayShare> shares;
  for (const double s : strengths) shares.push_back({s});
  return shares;
}

/// Of a mean of two estimates: .7 s² / n^1.5, and s² / n of those that are drawn.
double variance(const std::vector<RayShare>& shares, const DrawnRays& drawn) {
  double sum = drawn.rays > 0 ? drawn.strength * drawn.strength / (2 * drawn.rays) : 0;
  for (const RayShare& share : shares)
    if (share.way == RayWay::own)
      sum += 0.7 * share.strength * share.strength / std::pow(2 * share.rays, 1.5);
  return sum;
}

double rays_in_all(const std::vector<RayShare>& shares, const DrawnRays& drawn) {
  double sum = 2 * drawn.rays;
  for (const RayShare& share : shares) sum += 2 * share.rays;
  return sum;
}

int count_of(const std::vector<RayShare>& shares, RayWay way) {
  return static_cast<int>(std::count_if(shares.begin(), shares.end(),
                                        [&](const RayShare& share) { return share.way == way; }));
}

TEST(RayShares, MeetTheVarianceWithFewerRaysWhereManyAreWeak) {
  std::vector<double> strengths = {12, 5, 3};
  for (int k = 0; k < 300; ++k) strengths.push_back(0.3 / (1 + 0.1 * k));
  std::vector<RayShare> shares = of_strengths(strengths);
  const DrawnRays drawn = share_rays(shares, 1e6);
  EXPECT_LE(variance(shares, drawn), 1);
  EXPECT_GT(variance(shares, drawn), 0.7);
  EXPECT_LT(rays_in_all(shares, drawn), 2 * 150);
  EXPECT_GT(count_of(shares, RayWay::drawn), 250);
  double sum = 0;
  for (const RayShare& share : shares) {
    EXPECT_EQ(share.rays > 0, share.way == RayWay::own);
    if (share.way == RayWay::drawn) sum += share.strength;
  }
  EXPECT_DOUBLE_EQ(sum, drawn.strength);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(shares[static_cast<std::size_t>(k)].way, RayWay::own);
}

TEST(RayShares, GiveFewEmittersRaysOfTheirOwn) {
  std::vector<RayShare> shares = of_strengths({80, 20, 50});
  const DrawnRays drawn = share_rays(shares, 1e6);
  EXPECT_EQ(drawn.rays, 0);
  EXPECT_EQ(count_of(shares, RayWay::own), 3);
  EXPECT_LE(variance(shares, drawn), 1);
  EXPECT_GT(shares[0].rays, shares[2].rays);
  EXPECT_GT(shares[2].rays, shares[1].rays);
}

TEST(RayShares, LookExactlyWhereRaysWouldBeMore) {
  std::vector<RayShare> shares = of_strengths({1, 100, 2});
  const DrawnRays drawn = share_rays(shares, 40);
  EXPECT_EQ(shares[1].way, RayWay::exact);
  EXPECT_EQ(count_of(shares, RayWay::exact), 1);
  EXPECT_LE(variance(shares, drawn), 1);
  // What it would have taken is not asked of the others.
  std::vector<RayShare> without = of_strengths({1, 2});
  share_rays(without, 40);
  EXPECT_EQ(shares[0].rays, without[0].rays);
  EXPECT_EQ(shares[2].rays, without[1].rays);
}

TEST(RayShares, KeepWhatIsSettled) {
  std::vector<RayShare> shares = of_strengths({4, 0.2, 30});
  shares[0].way = RayWay::exact;
  shares[1].way = RayWay::drawn;
  const DrawnRays drawn = share_rays(shares, 1e6);
  EXPECT_EQ(shares[0].way, RayWay::exact);
  EXPECT_EQ(shares[1].way, RayWay::drawn);
  EXPECT_EQ(shares[2].way, RayWay::own);
  EXPECT_EQ(drawn.strength, 0.2);
  EXPECT_GE(drawn.rays, 1);
}

TEST(RayShares, DoNotTellEqualOnesApart) {
  std::vector<double> strengths;
  for (int k = 0; k < 200; ++k) strengths.push_back(0.4 * (1 + (k % 3) * 1e-15));
  std::vector<RayShare> shares = of_strengths(strengths);
  share_rays(shares, 1e6);
  for (const RayShare& share : shares) EXPECT_EQ(share.way, shares.front().way);
}

TEST(RayShares, OfNothingAreNone) {
  std::vector<RayShare> none;
  EXPECT_EQ(share_rays(none, 10).rays, 0);
}

}  // namespace
}  // namespace halfshade
