#pragma once

#include "solver/heat/heat.h"
#include "tests/support/analytic.h"
#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

/// The furnace of data/thermal_furnace.md, its small linear systems, and runs of the program on it.
namespace halfshade::test {

using Json = nlohmann::json;
using Vector5 = Eigen::Matrix<double, 5, 1>;

inline const std::string furnace = data_file("thermal_furnace.obj").string();

/// Of the furnace's surfaces in the order of its groups, with the opening behind them, and areas.
struct Furnace {
  Eigen::Matrix<double, 6, 6> factors = Eigen::Matrix<double, 6, 6>::Zero();
  Vector5 area{2, 1.5, 1.5, 3, 3};
};

inline Furnace make_furnace() {
  const double a = 2, b = 1, c = 1.5;
  Furnace result;
  auto& F = result.factors;
  F(0, 5) = F(5, 0) = opposed_rectangles(a, b, c);
  F(1, 2) = F(2, 1) = opposed_rectangles(b, c, a);
  F(3, 4) = F(4, 3) = opposed_rectangles(a, c, b);
  for (const int i : {0, 5}) {
    for (const int j : {1, 2}) F(i, j) = perpendicular_rectangles(b, a, c);
    for (const int j : {1, 2}) F(j, i) = perpendicular_rectangles(b, c, a);
    for (const int j : {3, 4}) F(i, j) = perpendicular_rectangles(a, b, c);
    for (const int j : {3, 4}) F(j, i) = perpendicular_rectangles(a, c, b);
  }
  for (const int i : {1, 2})
    for (const int j : {3, 4}) {
      F(i, j) = perpendicular_rectangles(c, b, a);
      F(j, i) = perpendicular_rectangles(c, a, b);
    }
  return result;
}

struct Balance {
  Vector5 net_power, irradiance;
};

/// What surfaces of these emissivities that emit so much give net, below an opening that sends
/// `space`.
inline Balance solved(const Furnace& in, const Vector5& emissivity, const Vector5& exitance,
                      double space) {
  const Eigen::Matrix<double, 5, 5> F = in.factors.topLeftCorner<5, 5>();
  const Vector5 rho = Vector5::Ones() - emissivity, through = in.factors.col(5).head<5>() * space;
  const Eigen::Matrix<double, 5, 5> equations =
      Eigen::Matrix<double, 5, 5>::Identity() - rho.asDiagonal() * F;
  const Vector5 radiosity = equations.partialPivLu().solve(exitance + rho.cwiseProduct(through));
  const Vector5 irradiance = F * radiosity + through;
  return {in.area.cwiseProduct(radiosity - irradiance), irradiance};
}

inline double black(double kelvin) { return stefan_boltzmann * std::pow(kelvin, 4); }

class FurnaceRuns : public testing::Test {
 protected:
  Outcome run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), program);
    return run_program(std::move(arguments), folder_.path());
  }

  void save_factors(const std::string& scene, const std::string& tolerance = "1e-8") {
    const Outcome outcome =
        run({"factors", scene, "-q", "--by", "face", "--tolerance", tolerance, "-o", "f.mtx"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  Json exchange(const std::vector<std::string>& options, const std::string& scene = furnace) {
    std::vector<std::string> arguments = {"solve", scene, "-q", "-o", "r.vtu", "--json", "r.json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(contents(folder_.path() / "r.json"));
  }

  TempDir folder_;
};

/// The furnace in several bands, its last wall at a temperature that tells what it gives net.
struct BandedFurnace {
  std::vector<Band> bands;
  Eigen::Matrix<double, 5, Eigen::Dynamic> emissivity;
  Vector5 kelvin{900, 700, 500, 1100, 0};

  std::vector<Balance> balances(double wall, double space) const {
    Vector5 all = kelvin;
    all[4] = wall;
    std::vector<Balance> result;
    for (std::size_t k = 0; k < bands.size(); ++k) {
      const auto part = [&](double t) {
        return t > 0 ? black(t) * (blackbody_share_below(bands[k].longest, t) -
                                   blackbody_share_below(bands[k].shortest, t))
                     : 0;
      };
      const Vector5 e = emissivity.col(static_cast<Eigen::Index>(k));
      Vector5 exitance;
      for (int i = 0; i < 5; ++i) exitance[i] = e[i] * part(all[i]);
      result.push_back(solved(make_furnace(), e, exitance, part(space)));
    }
    return result;
  }

  /// Where the last wall gives net nothing in all bands together, by halving.
  double adiabatic_wall(double space) const {
    double low = 1, high = 5000;
    for (int step = 0; step < 100; ++step) {
      const double middle = (low + high) / 2;
      double net = 0;
      for (const Balance& band : balances(middle, space)) net += band.net_power[4];
      (net < 0 ? low : high) = middle;
    }
    return low;
  }

  std::string materials(const std::string& of_wall) const {
    Json json, list = Json::array();
    for (const Band& band : bands) {
      const Json longest = std::isinf(band.longest) ? Json() : Json(band.longest);
      list.push_back({{"name", band.name}, {"wavelengths_um", {band.shortest, longest}}});
    }
    json["bands"] = list;
    const char* const names[] = {"floor", "x_low", "x_high", "y_low", "y_high"};
    for (int i = 0; i < 5; ++i) {
      Json& one = json[names[i]];
      const Eigen::VectorXd e = emissivity.row(i);
      one["emissivity"] = std::vector<double>(e.begin(), e.end());
      if (i < 4) one["temperature"] = kelvin[i];
    }
    json["y_high"].update(Json::parse(of_wall));
    return json.dump();
  }
};

inline BandedFurnace banded_furnace(std::size_t count) {
  const double limits[] = {0, 2, 3.5, 6, 12, HUGE_VAL};
  BandedFurnace result;
  result.emissivity.resize(5, static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    const double longest = k + 1 == count ? HUGE_VAL : limits[k + 1];
    result.bands.push_back({"band " + std::to_string(k), true, limits[k], longest});
    for (int i = 0; i < 5; ++i)
      result.emissivity(i, static_cast<Eigen::Index>(k)) =
          0.15 + 0.8 * std::fmod(0.37 * (i + 1) + 0.29 * static_cast<double>(k * (i + 2)), 1);
  }
  return result;
}

}  // namespace halfshade::test
