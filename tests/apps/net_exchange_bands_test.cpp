// Heat in any number of bands, against the small linear systems of data/thermal_furnace.md.

#include "tests/support/furnace.h"

#include <algorithm>
#include <array>
#include <utility>

namespace halfshade {
namespace {

using test::Balance;
using test::banded_furnace;
using test::BandedFurnace;
using test::furnace;
using test::Json;
using test::Vector5;

void expect_balance(const Json& net, const std::vector<Balance>& expected) {
  double scale = 0;
  for (const Balance& band : expected)
    scale = std::max(scale, band.net_power.cwiseAbs().maxCoeff());
  for (std::size_t g = 0; g < 5; ++g) {
    const Json& group = net.at("groups").at(g);
    ASSERT_EQ(group.at("net_power_w").size(), expected.size());
    double total = 0;
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const double power = expected[k].net_power[static_cast<Eigen::Index>(g)];
      total += power;
      EXPECT_NEAR(group.at("net_power_w").at(k).get<double>(), power, 1e-8 * scale) << g << k;
    }
    EXPECT_NEAR(group.at("total_net_power_w").get<double>(), total, 1e-8 * scale) << g;
  }
  double to_space = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    to_space += expected[k].net_power.sum();
    EXPECT_NEAR(net.at("surroundings_net_power_w").at(k).get<double>(),
                -expected[k].net_power.sum(), 1e-8 * scale);
  }
  EXPECT_NEAR(net.at("surroundings_total_net_power_w").get<double>(), -to_space, 1e-8 * scale);
}

class NetExchangeOfBands : public test::FurnaceRuns {
 protected:
  /// With f.mtx saved: one re-radiating wall, and surroundings of so many K.
  void expect_balanced_wall(const BandedFurnace& box, double space) {
    const double wall = box.adiabatic_wall(space);
    const auto heat = folder_.write("heat.json", box.materials(R"({"net_flux": 0})"));
    const Json net = exchange({"--factors", "f.mtx", "--surroundings", std::to_string(space),
                               "--materials", heat.string()})
                         .at("net_exchange");
    EXPECT_NEAR(net.at("groups").at(4).at("temperature_k").get<double>(), wall, 1e-8 * wall);
    expect_balance(net, box.balances(wall, space));
  }
};

TEST_F(NetExchangeOfBands, OfAnyNumberOfBandsIsTheSolutionOfAsManySystems) {
  save_factors(furnace);
  for (const std::size_t count : {2U, 4U, 5U})
    for (const double space : {0., 800.}) {
      SCOPED_TRACE(testing::Message() << count << " bands, " << space << " K");
      const BandedFurnace box = banded_furnace(count);
      const auto heat = folder_.write("heat.json", box.materials(R"({"temperature": 600})"));
      const Json report = exchange({"--factors", "f.mtx", "--surroundings", std::to_string(space),
                                    "--materials", heat.string()});
      expect_balance(report.at("net_exchange"), box.balances(600, space));
      for (const Json& channel : report.at("radiosity").at("channel"))
        EXPECT_LT(channel.at("balance").get<double>(), 1e-9);
      EXPECT_EQ(report.at("radiosity").at("channels"), count > 3 ? 1 : 3);
      double emitted = 0;
      for (const Json& power : report.at("groups").at(1).at("emitted_power"))
        emitted += power.get<double>();
      double expected = 0;
      for (std::size_t k = 0; k < count; ++k)
        expected += 1.5e6 * box.emissivity(1, static_cast<Eigen::Index>(k)) *
                    blackbody_exitance(700, box.bands)[static_cast<Eigen::Index>(k)];
      EXPECT_NEAR(emitted, expected, 1e-9 * expected);
    }
}

TEST_F(NetExchangeOfBands, OfARadiatingWallInSeveralBandsBalancesTheirSum) {
  save_factors(furnace);
  for (const std::size_t count : {2U, 4U})
    for (const double space : {0., 300., 1200.}) {
      SCOPED_TRACE(testing::Message() << count << " bands, " << space << " K");
      expect_balanced_wall(banded_furnace(count), space);
    }
}

// Bands may hold next to nothing of the spectrum.
TEST_F(NetExchangeOfBands, OfARadiatingWallBalancesNarrowAndDistantBands) {
  save_factors(furnace);
  const std::pair<std::array<double, 4>, double> all[] = {
      {{.4, .5, .5, .7}, 300}, {{3, 3.0001, 10, 10.001}, 300}, {{3, 3.1, 1e3, HUGE_VAL}, 1200}};
  for (const auto& [limits, space] : all) {
    SCOPED_TRACE(testing::Message() << limits[0] << " µm on");
    BandedFurnace box = banded_furnace(2);
    for (std::size_t k = 0; k < 2; ++k) {
      box.bands[k].shortest = limits[2 * k];
      box.bands[k].longest = limits[2 * k + 1];
    }
    expect_balanced_wall(box, space);
  }
}

// What arrives in a band is what a black body sends in it, not in all.
TEST_F(NetExchangeOfBands, OfARadiatingWallInAPartOfTheSpectrumIsAsHotAsThat) {
  save_factors(furnace);
  BandedFurnace box = banded_furnace(2);
  box.bands = {{"window", true, 3, 5}};
  box.emissivity.conservativeResize(Eigen::NoChange, 1);
  const double wall = box.adiabatic_wall(300);
  const auto heat = folder_.write("heat.json", box.materials(R"({"net_flux": 0})"));
  const Json net =
      exchange({"--factors", "f.mtx", "--surroundings", "300", "--materials", heat.string()})
          .at("net_exchange");
  EXPECT_NEAR(net.at("groups").at(4).at("temperature_k").get<double>(), wall, 1e-8 * wall);
}

TEST_F(NetExchangeOfBands, SaysWhereTheyTellNoTemperature) {
  save_factors(furnace);
  for (const std::size_t count : {1U, 2U}) {
    BandedFurnace box = banded_furnace(2);
    box.bands = {{"ultraviolet", true, .3, .4}, {"visible", true, .4, .7}};
    box.bands.resize(count);
    box.emissivity.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(count));
    box.kelvin << 4, 3, 4, 5, 0;
    folder_.write("heat.json", box.materials(R"({"net_flux": 0})"));
    const test::Outcome outcome = run({"solve", furnace, "--factors", "f.mtx", "--surroundings",
                                       "3", "--materials", "heat.json", "-o", "r.vtu"});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("of material 'y_high"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("too little arrives there in the bands"), std::string::npos);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

// In one band the temperature needs no emissivity, and is the same as in bands of the same one.
TEST_F(NetExchangeOfBands, InBandsThatAreAlikeIsThatOfOne) {
  save_factors(furnace);
  BandedFurnace box = banded_furnace(4);
  for (int k = 0; k < 4; ++k) box.emissivity.col(k) = Vector5{.8, .6, .9, .5, .35};
  const auto heat = folder_.write("heat.json", box.materials(R"({"net_flux": 0})"));
  const Json one = exchange({"--factors", "f.mtx", "--surroundings", "300"}).at("net_exchange");
  const Json four =
      exchange({"--factors", "f.mtx", "--surroundings", "300", "--materials", heat.string()})
          .at("net_exchange");
  for (std::size_t g = 0; g < 5; ++g) {
    EXPECT_NEAR(four.at("groups").at(g).at("total_net_power_w").get<double>(),
                one.at("groups").at(g).at("net_power_w").at(0).get<double>(), 1e-3);
    EXPECT_NEAR(four.at("groups").at(g).at("temperature_k").get<double>(),
                one.at("groups").at(g).at("temperature_k").get<double>(), 1e-5);
  }
}

// Polynomials have meshes that follow the light; bands share one.
TEST_F(NetExchangeOfBands, OfManyBandsIsTheSameByAnyMethod) {
  BandedFurnace box = banded_furnace(5);
  box.emissivity.setOnes();
  const auto heat = folder_.write("heat.json", box.materials(R"({"net_flux": 0})"));
  const double wall = box.adiabatic_wall(800);
  const std::vector<Balance> expected = box.balances(wall, 800);
  for (const std::vector<std::string>& method : std::vector<std::vector<std::string>>{
           {"--tolerance", "1e-2"}, {"--method", "matrix", "--elements", "300"}}) {
    std::vector<std::string> options = {"--surroundings", "800", "--materials", heat.string()};
    options.insert(options.end(), method.begin(), method.end());
    const Json net = exchange(options).at("net_exchange");
    EXPECT_NEAR(net.at("groups").at(4).at("temperature_k").get<double>(), wall, 1e-2 * wall);
    for (std::size_t k = 0; k < 5; ++k) {
      const double scale = expected[k].net_power.cwiseAbs().maxCoeff();
      for (std::size_t g = 0; g < 5; ++g)
        EXPECT_NEAR(net.at("groups").at(g).at("net_power_w").at(k).get<double>(),
                    expected[k].net_power[static_cast<Eigen::Index>(g)], 1e-2 * scale)
            << method[0] << g << k;
    }
  }
}

}  // namespace
}  // namespace halfshade
