// Heat that surfaces exchange, against the small linear systems of data/thermal_furnace.md.

#include "tests/support/furnace.h"

#include <algorithm>

namespace halfshade {
namespace {

using test::Balance;
using test::banded_furnace;
using test::black;
using test::Furnace;
using test::furnace;
using test::Json;
using test::make_furnace;
using test::solved;
using test::Vector5;

using NetExchange = test::FurnaceRuns;

TEST_F(NetExchange, OfAFurnaceIsTheSolutionOfItsLinearSystem) {
  save_factors(furnace);
  const Furnace box = make_furnace();
  const Vector5 emissivity{.8, .6, .9, .5, 0};
  const Vector5 exitance{.8 * black(900), .6 * black(700), .9 * black(500), .5 * black(1100), 0};
  for (const double kelvin : {0., 300., 800., 1200.}) {
    const Balance expected = solved(box, emissivity, exitance, black(kelvin));
    const Json report = exchange({"--factors", "f.mtx", "--surroundings", std::to_string(kelvin)});
    const Json& net = report.at("net_exchange");
    EXPECT_EQ(net.at("unit_m"), 0.001);
    const double scale = expected.net_power.cwiseAbs().maxCoeff();
    for (std::size_t g = 0; g < 5; ++g) {
      const Json& group = net.at("groups").at(g);
      const auto i = static_cast<Eigen::Index>(g);
      ASSERT_EQ(group.at("net_power_w").size(), 1U);
      EXPECT_NEAR(group.at("area_m2").get<double>(), box.area[i], 1e-12);
      EXPECT_NEAR(group.at("net_power_w").at(0).get<double>(), expected.net_power[i], 1e-8 * scale);
      EXPECT_NEAR(group.at("net_flux_w_per_m2").at(0).get<double>(),
                  expected.net_power[i] / box.area[i], 1e-8 * scale);
    }
    EXPECT_EQ(net.at("groups").at(0).at("temperature_k"), 900);
    EXPECT_NEAR(net.at("groups").at(4).at("temperature_k").get<double>(),
                std::pow(expected.irradiance[4] / stefan_boltzmann, .25), 1e-6);
    EXPECT_NEAR(net.at("surroundings_net_power_w").at(0).get<double>(), -expected.net_power.sum(),
                1e-8 * scale);
    EXPECT_LT(report.at("radiosity").at("channel").at(0).at("balance").get<double>(), 1e-9);
  }
}

// As the page of the scene has it.
TEST_F(NetExchange, OfTheFurnaceIsAsItsPageSays) {
  save_factors(furnace);
  const Json net = exchange({"--factors", "f.mtx"}).at("net_exchange");
  EXPECT_TRUE(net.at("surroundings_temperature_k").is_null());
  EXPECT_NEAR(net.at("groups").at(3).at("net_power_w").at(0).get<double>(), 94068.16422418, 1e-3);
  EXPECT_NEAR(net.at("surroundings_net_power_w").at(0).get<double>(), -63519.66242289, 1e-3);
  EXPECT_NEAR(net.at("groups").at(4).at("temperature_k").get<double>(), 843.2922064434, 1e-6);
}

TEST_F(NetExchange, OfTwoBandsIsTheSolutionOfTwoSystems) {
  save_factors(furnace);
  const Furnace box = make_furnace();
  const Json report = exchange({"--factors", "f.mtx", "--surroundings", "300", "--materials",
                                test::data_file("thermal_furnace_bands.json").string()});
  const Json& net = report.at("net_exchange");
  EXPECT_EQ(net.at("bands").at(1).at("name"), "far");
  const Vector5 emissivity[] = {{.8, .6, .9, .5, .2}, {.6, .7, .3, .8, .9}};
  const double kelvin[] = {900, 700, 500, 1100, 600};
  // Computed apart, with Planck's integral by Gauss's rule.
  const double page[] = {1270.2666895, -5776.6249552};
  for (int band = 0; band < 2; ++band) {
    const auto part = [band](double t) {
      const double near = blackbody_share_below(3, t);
      return (band == 0 ? near : 1 - near) * black(t);
    };
    Vector5 exitance;
    for (int i = 0; i < 5; ++i) exitance[i] = emissivity[band][i] * part(kelvin[i]);
    const Balance expected = solved(box, emissivity[band], exitance, part(300));
    const double scale = expected.net_power.cwiseAbs().maxCoeff();
    const auto k = static_cast<std::size_t>(band);
    for (std::size_t g = 0; g < 5; ++g) {
      const Json& powers = net.at("groups").at(g).at("net_power_w");
      ASSERT_EQ(powers.size(), 2U);
      EXPECT_NEAR(powers.at(k).get<double>(), expected.net_power[static_cast<Eigen::Index>(g)],
                  1e-8 * scale);
      if (band == 0 && g < 2) {
        EXPECT_NEAR(powers.at(k).get<double>(), page[g], 1e-4);
      }
    }
    EXPECT_NEAR(net.at("surroundings_net_power_w").at(k).get<double>(), -expected.net_power.sum(),
                1e-8 * scale);
  }
}

// Black surfaces are even, so that light as polynomials has the same solution.
TEST_F(NetExchange, OfBlackSurfacesIsTheSameByAnyMethod) {
  const Furnace box = make_furnace();
  const auto heat = folder_.write("black.json", R"({
    "floor": {"emissivity": 1, "temperature": 900}, "x_low": {"emissivity": 1, "temperature": 700},
    "x_high": {"emissivity": 1, "temperature": 500}, "y_low": {"emissivity": 1, "temperature": 1100},
    "y_high": {"emissivity": 1, "temperature": 300}})");
  const Vector5 exitance{black(900), black(700), black(500), black(1100), black(300)};
  const Balance expected = solved(box, Vector5::Ones(), exitance, black(800));
  const double scale = expected.net_power.cwiseAbs().maxCoeff();
  for (const std::vector<std::string>& method : std::vector<std::vector<std::string>>{
           {"--tolerance", "1e-2"}, {"--method", "matrix", "--elements", "500"}}) {
    std::vector<std::string> options = {"--surroundings", "800", "--materials", heat.string()};
    options.insert(options.end(), method.begin(), method.end());
    const Json net = exchange(options).at("net_exchange");
    for (std::size_t g = 0; g < 5; ++g)
      EXPECT_NEAR(net.at("groups").at(g).at("net_power_w").at(0).get<double>(),
                  expected.net_power[static_cast<Eigen::Index>(g)], 5e-3 * scale)
          << method[0] << g;
  }
}

TEST_F(NetExchange, OfAPlateUnderTheSkyIsItsOwn) {
  folder_.write("plate.obj",
                "mtllib plate.mtl\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nusemtl m\nf 1 2 3 4\n");
  folder_.write("plate.mtl", "newmtl m\nemissivity 0.3\ntemperature 400\n");
  for (const double kelvin : {250., 500.}) {
    const Json report = exchange({"--surroundings", std::to_string(kelvin)}, "plate.obj");
    const double expected = 2 * 0.3 * (black(400) - black(kelvin));
    const Json& net = report.at("net_exchange");
    EXPECT_NEAR(net.at("groups").at(0).at("net_power_w").at(0).get<double>(), expected, 1e-9);
    EXPECT_NEAR(net.at("surroundings_net_power_w").at(0).get<double>(), -expected, 1e-9);
    const Json& group = report.at("groups").at(0);
    EXPECT_NEAR(group.at("mean_irradiance_w_per_m2").at(0).get<double>(), black(kelvin), 1e-9);
    EXPECT_TRUE(report.at("warnings").empty());
  }
}

TEST_F(NetExchange, WithSurroundingsOfTheSameTemperatureIsNothing) {
  const auto heat = folder_.write("even.json", R"({
    "floor": {"temperature": 800}, "x_low": {"temperature": 800}, "x_high": {"temperature": 800},
    "y_low": {"temperature": 800}})");
  save_factors(furnace, "1e-4");
  const Json net =
      exchange({"--factors", "f.mtx", "--surroundings", "800", "--materials", heat.string()})
          .at("net_exchange");
  for (const Json& group : net.at("groups"))
    EXPECT_NEAR(group.at("net_power_w").at(0).get<double>(), 0, 1e-9);
  EXPECT_NEAR(net.at("groups").at(4).at("temperature_k").get<double>(), 800, 1e-9);
}

/// The furnace under a lid; materials beside it say what it is.
class LiddedFurnace : public NetExchange {
 protected:
  void SetUp() override {
    folder_.write("lidded.obj", test::contents(furnace) + "\ng lid\nusemtl lid\nf 8 7 6 5\n");
    const auto mtl = test::data_file("thermal_furnace.mtl");
    folder_.write("thermal_furnace.mtl", test::contents(mtl) + "\nnewmtl lid\n");
    folder_.write("lidded.json", R"({"unit": "mm"})");
  }

  Json exchange_under(const std::string& lid, const std::string& kelvin,
                      std::vector<std::string> options) {
    folder_.write("heat.json", lid);
    options.insert(options.end(), {"--materials", "heat.json", "--surroundings", kelvin});
    return exchange(options, "lidded.obj").at("net_exchange");
  }
};

// A plate has one temperature and sends it out on both sides: e = (H + H') / 2, where H' is what
// comes from outside. So its inner side has B = (1 - eps / 2) H + eps H' / 2.
TEST_F(LiddedFurnace, OfTwoSidesHasATemperatureThatBothSidesBalance) {
  folder_.write("heat.json", R"({"lid": {"emissivity": 0.3, "two_sided": true}})");
  ASSERT_EQ(run({"factors", "lidded.obj", "-q", "--by", "face", "--tolerance", "1e-8", "-o",
                 "f.mtx", "--materials", "heat.json"})
                .exit_code,
            0);
  for (const double kelvin : {0., 400.}) {
    using Vector6 = Eigen::Matrix<double, 6, 1>;
    const Eigen::Matrix<double, 6, 6> F = make_furnace().factors;
    const Vector6 rho{.2, .4, .1, .5, 1, .85};
    const Vector6 exitance{
        .8 * black(900),    .6 * black(700), .9 * black(500), .5 * black(1100), 0,
        .15 * black(kelvin)};
    const Eigen::Matrix<double, 6, 6> equations =
        Eigen::Matrix<double, 6, 6>::Identity() - rho.asDiagonal() * F;
    const Vector6 radiosity = equations.partialPivLu().solve(exitance);
    const Vector6 irradiance = F * radiosity;
    const double lid = std::pow((irradiance[5] + black(kelvin)) / 2 / stefan_boltzmann, .25);
    const std::string one = R"({"lid": {"emissivity": 0.3, "two_sided": true, "net_flux": 0}})";
    const Json net = exchange_under(one, std::to_string(kelvin), {"--factors", "f.mtx"});
    EXPECT_NEAR(net.at("groups").at(5).at("temperature_k").get<double>(), lid, 1e-6);
    EXPECT_NEAR(net.at("groups").at(5).at("net_power_w").at(0).get<double>(), 0, 1e-6);
    EXPECT_NEAR(net.at("groups").at(4).at("temperature_k").get<double>(),
                std::pow(irradiance[4] / stefan_boltzmann, .25), 1e-6);
    EXPECT_NEAR(net.at("groups").at(0).at("net_power_w").at(0).get<double>(),
                2 * (radiosity[0] - irradiance[0]), 1e-3);
    EXPECT_NEAR(net.at("surroundings_net_power_w").at(0).get<double>(),
                .6 * (black(kelvin) - black(lid)), 1e-3);
  }
}

// In bands of the same emissivity it is the same, and by any method.
TEST_F(LiddedFurnace, OfTwoSidesIsTheSameInBandsAndByPolynomials) {
  const std::string one = R"({"lid": {"emissivity": 1, "two_sided": true, "net_flux": 0}})";
  folder_.write("black.json", R"({
    "bands": [{"name": "near", "wavelengths_um": [0, 4]}, {"name": "far", "wavelengths_um": [4, null]}],
    "floor": {"emissivity": 1, "temperature": 900}, "x_low": {"emissivity": 1, "temperature": 700},
    "x_high": {"emissivity": 1, "temperature": 500}, "y_low": {"emissivity": 1, "temperature": 1100},
    "y_high": {"emissivity": 1, "temperature": 800},
    "lid": {"emissivity": 1, "two_sided": true, "net_flux": 0}})");
  const std::string bands = test::contents(folder_.path() / "black.json");
  Json grey = Json::parse(bands);
  grey.erase("bands");
  const Eigen::Matrix<double, 6, 6> F = make_furnace().factors;
  double arriving = 0;
  const double kelvin[] = {900, 700, 500, 1100, 800};
  for (int i = 0; i < 5; ++i) arriving += F(5, i) * black(kelvin[i]);
  const double lid = std::pow((arriving + black(400)) / 2 / stefan_boltzmann, .25);
  for (const std::string& materials : {grey.dump(), bands}) {
    const Json net = exchange_under(materials, "400", {"--tolerance", "1e-2"});
    EXPECT_NEAR(net.at("groups").at(5).at("temperature_k").get<double>(), lid, 1e-3 * lid);
  }
}

TEST_F(LiddedFurnace, SaysWhatNothingFixes) {
  Json all;
  for (const char* const name : {"floor", "x_low", "x_high", "y_low", "y_high", "lid"})
    all[name] = {{"net_flux", 0}};
  folder_.write("closed.json", all.dump());
  Json two = all;
  for (Json& one : two) one["emissivity"] = {0.5, 0.3};
  two["bands"] = Json::parse(
      R"([{"name": "a", "wavelengths_um": [0, 3]}, {"name": "b", "wavelengths_um": [3, null]}])");
  folder_.write("bands.json", two.dump());
  Json cold = all;
  cold["lid"] = {{"temperature", 0}};
  folder_.write("cold.json", cold.dump());
  all["lid"]["two_sided"] = true;
  folder_.write("sides.json", all.dump());
  save_factors("lidded.obj", "1e-4");
  struct Wrong {
    std::vector<std::string> options;
    std::string says;
  };
  const std::string nothing = "has a net flux of 0, and so has all that it exchanges heat with";
  const std::vector<Wrong> wrong = {
      {{"--materials", "closed.json", "--surroundings", "300"}, nothing},
      {{"--materials", "closed.json", "--surroundings", "300", "--factors", "f.mtx"}, nothing},
      {{"--materials", "bands.json", "--surroundings", "300", "--factors", "f.mtx"}, nothing},
      {{"--materials", "closed.json"}, "'temperature'"},
      {{"--materials", "cold.json", "--factors", "f.mtx"}, "--surroundings"},
      {{"--materials", "bands.json"}, "no face sends out heat"},
      {{"--materials", "sides.json", "--surroundings", "300"}, "faces have two sides"}};
  for (const Wrong& one : wrong) {
    std::vector<std::string> arguments = {"solve", "lidded.obj", "-o", "r.vtu"};
    arguments.insert(arguments.end(), one.options.begin(), one.options.end());
    const test::Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 3) << testing::PrintToString(arguments);
    EXPECT_NE(outcome.err.find(one.says), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

// What is as warm as its surroundings sends out nothing more than they do.
TEST_F(LiddedFurnace, IsInEquilibriumByPolynomials) {
  Json all;
  for (const char* const name : {"floor", "x_low", "x_high", "y_low", "lid"})
    all[name] = {{"temperature", 800}, {"emissivity", 0.5}};
  const Json net = exchange_under(all.dump(), "800", {});
  for (const Json& group : net.at("groups"))
    EXPECT_NEAR(group.at("net_power_w").at(0).get<double>(), 0, 1e-9);
}

TEST_F(NetExchange, SumsOfASavedMatrixAreItsGroups) {
  save_factors(furnace, "1e-6");
  const test::Outcome outcome =
      run({"factors", furnace, "--from", "f.mtx", "-o", "g.csv", "--by", "group", "--enforce"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string table = test::contents(folder_.path() / "g.csv");
  EXPECT_NE(table.find("surface,area,floor,x_low,x_high,y_low,y_high,space,row_sum,error\n"),
            std::string::npos);
  EXPECT_NE(table.find("\nfloor,2000000,0,0.1371475"), std::string::npos) << table;
}

TEST_F(NetExchange, SaysInOneSentenceWhatIsWrong) {
  const std::string cube = test::data_file("furnace_cube.obj").string();
  const std::string s1 = test::data_file("s1.obj").string();
  save_factors(cube, "1e-4");
  ASSERT_EQ(run({"factors", cube, "-q", "-o", "g.mtx"}).exit_code, 0);
  folder_.write("odd.json", R"({"unit": "furlong"})");
  folder_.write("odd.obj", "mtllib odd.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
  folder_.write("odd.mtl", "newmtl m\nemissivity 1\ntemperature 300\n");
  folder_.write("four.json", banded_furnace(4).materials(R"({"temperature": 600})"));
  folder_.write("two.json", banded_furnace(2).materials(R"({"net_flux": 0})"));
  struct Wrong {
    std::vector<std::string> arguments;
    int exit_code;
    std::string says;
  };
  const std::vector<Wrong> all = {
      {{"solve", s1, "--factors", "f.mtx"}, 3, "the matrix has 6 rows and the scene 3 faces"},
      {{"solve", cube, "--factors", "g.mtx"}, 3, "the matrix is not by face"},
      {{"factors", s1, "--from", "f.mtx", "-o", "o.csv"}, 3, "do not belong together"},
      {{"factors", cube, "--from", "f.csv", "-o", "o.csv"}, 2, ".mtx"},
      {{"factors", cube, "--from", "none.mtx", "-o", "o.csv"}, 3, "none.mtx"},
      {{"factors", cube, "--from", "f.mtx", "-o", "f.mtx"}, 2, "--from"},
      {{"factors", cube, "--from", "f.mtx", "-o", "o.csv", "--rays", "5"}, 2, "--from"},
      {{"solve", cube, "--factors", "f.txt"}, 2, "f.txt"},
      {{"solve", cube, "--factors", "f.mtx", "--order", "2"}, 2, "--order"},
      {{"solve", cube, "--factors", "f.mtx", "-o", "f.names.csv.vtu", "--json", "f.names.csv"},
       2,
       "f.names.csv"},
      {{"solve", cube, "--surroundings", "-3"}, 2, "--surroundings"},
      {{"solve", cube, "--surroundings", "3", "--bounces", "1"}, 2, "--bounces"},
      {{"solve", test::data_file("cornell_box.obj").string(), "--surroundings", "300"},
       3,
       "differs between red, green and blue"},
      {{"solve", "odd.obj", "--json", "r.json"}, 3, "'furlong'"},
      {{"probe", furnace, "--grid", "floor", "--spacing", "500", "-o", "o.csv", "--materials",
        "four.json"},
       3,
       "4 bands, and probe knows at most 3"},
      {{"study", furnace, "-o", "s", "--materials", "two.json"}, 3, "net flux of 0 in 2 bands"},
      {{"solve", furnace, "--materials", "four.json", "--goal", "floor"}, 2, "three channels"},
  };
  for (const Wrong& wrong : all) {
    const test::Outcome outcome = run(wrong.arguments);
    EXPECT_EQ(outcome.exit_code, wrong.exit_code) << testing::PrintToString(wrong.arguments);
    EXPECT_NE(outcome.err.find(wrong.says), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

}  // namespace
}  // namespace halfshade
