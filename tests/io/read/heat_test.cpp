#include "tests/support/scene_texts.h"

#include <gmock/gmock.h>

namespace halfshade {
namespace {

const std::string obj_of_heat =
    "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng a\nusemtl m\nf 1 2 3\ng b\nusemtl n\n"
    "f 1 3 4\n";

SceneFile read_heat(const std::string& mtl, const std::string& materials = "") {
  const test::TempDir folder;
  folder.write("scene.mtl", mtl);
  const auto file = folder.write("scene.obj", obj_of_heat);
  return read_scene(
      file, materials.empty() ? std::filesystem::path() : folder.write("heat.json", materials));
}

void expect_heat_refused(const std::string& mtl, const std::string& materials,
                         const std::vector<std::string>& parts) {
  SCOPED_TRACE(mtl + materials);
  test::expect_error([&] { read_heat(mtl, materials); }, ErrorCode::invalid_input, parts);
}

const std::string grey = "newmtl m\nKd 0.5\nnewmtl n\nKd 0.25\n";

TEST(HeatValues, OfMtlFilesAreReflectancesAndExitances) {
  const SceneFile file =
      read_heat("newmtl m\nemissivity 0.75\ntemperature 600\nnewmtl n\nnet_flux 0\n");
  EXPECT_THAT(file.warnings, testing::IsEmpty());
  EXPECT_TRUE(file.heat.is_given);
  const std::vector<Material>& materials = file.scene.materials;
  EXPECT_EQ(materials.at(0).rho[1], 0.25);
  EXPECT_DOUBLE_EQ(materials[0].exitance[2], 0.75 * stefan_boltzmann * 600 * 600 * 600 * 600);
  EXPECT_EQ(materials.at(1).rho[0], 1);
  EXPECT_EQ(materials[1].exitance[0], 0);
  EXPECT_EQ(file.heat.materials.at(0).temperature, 600);
  EXPECT_TRUE(file.heat.materials.at(1).is_adiabatic);
  EXPECT_FALSE(read_heat(grey).heat.is_given);
}

TEST(HeatValues, OfMaterialsFilesOverrideTheScenes) {
  const std::string mtl = "newmtl m\nKd 0.5\nKe 7\nnewmtl n\nemissivity 0.5\ntemperature 500\n";
  const SceneFile file = read_heat(mtl, R"({"a": {"temperature": 300}, "n": {"emissivity": 1}})");
  const double black = stefan_boltzmann * 300 * 300 * 300 * 300;
  EXPECT_DOUBLE_EQ(file.scene.materials.at(1).exitance[0], 0.5 * black) << "instead of Ke";
  EXPECT_DOUBLE_EQ(file.scene.materials.at(0).exitance[0], black / 81 * 625) << "with the new ε";
  const SceneFile lamp = read_heat(mtl, R"({"n": {"exitance": 3}})");
  EXPECT_EQ(lamp.scene.materials.at(1).exitance[0], 3);
  EXPECT_FALSE(lamp.heat.materials.at(1).temperature);
}

TEST(HeatValues, BandsAreChannels) {
  const SceneFile file = read_heat(grey, R"({
    "bands": [{"name": "solar", "wavelengths_um": [0, 3]}, {"name": "far", "wavelengths_um": [3, null]}],
    "m": {"emissivity": [0.2, 0.9], "temperature": 1000}, "n": {"exitance": [5, 0]}})");
  ASSERT_EQ(file.heat.bands.size(), 2U);
  EXPECT_EQ(file.heat.bands[1].name, "far");
  const Material &m = file.scene.materials.at(0), &n = file.scene.materials.at(1);
  const double all = stefan_boltzmann * 1e12, share = blackbody_share_below(3, 1000);
  EXPECT_NEAR(m.exitance[0], 0.2 * share * all, 1e-9);
  EXPECT_NEAR(m.exitance[1], 0.9 * (1 - share) * all, 1e-9);
  EXPECT_EQ(m.exitance[2], 0);
  EXPECT_EQ(m.rho[2], 0);
  EXPECT_EQ(n.rho[0], 0.25);
  EXPECT_EQ(n.exitance[0], 5);
  const SceneFile one = read_heat(grey, R"({"bands": ["all"], "m": {"temperature": 1000}})");
  EXPECT_DOUBLE_EQ(one.scene.materials.at(0).exitance[2], 0.5 * all);
}

TEST(HeatValues, ThatContradictEachOtherAreRefused) {
  const std::string m = "newmtl n\nKd 0.5\nnewmtl m\n";
  expect_heat_refused(m + "temperature -1\n", "", {"scene.mtl:4", "'m'", "-1 K", "below 0 K"});
  expect_heat_refused(m + "emissivity 1.5\n", "", {"'m'", "emissivity is 1.5", "[0, 1]"});
  expect_heat_refused(m + "Kd 0.5\nemissivity 0.4\n", "", {"reflectance 0.5", "emissivity 0.4"});
  expect_heat_refused(m + "Ke 1\ntemperature 9\n", "", {"temperature 9 K", "exitance 1 W/m²"});
  expect_heat_refused(m + "temperature 9\nnet_flux 0\n", "", {"net_flux 0", "temperature 9 K"});
  expect_heat_refused(m + "net_flux 4\n", "", {"net flux is 4 W/m²", "only 0"});
  expect_heat_refused(m + "temperature 3 4 5\n", "", {"temperature", "single number"});
  expect_heat_refused("temperature 3\n", "", {"before any newmtl"});
  expect_heat_refused(grey, R"({"m": {"temperature": -5}})", {"heat.json", "'m'", "-5 K"});
  expect_heat_refused(grey, R"({"m": {"emissivity": 1.5}})",
                      {"'m': 'emissivity'", "1.5", "[0, 1]"});
  expect_heat_refused(grey, R"({"m": {"temperature": "hot"}})",
                      {"'temperature'", "must be a number"});
  expect_heat_refused(grey, R"({"m": {"emissivity": 0.5, "reflectance": 0.4}})",
                      {"'m'", "add up to 1"});
  expect_heat_refused(grey, R"({"m": {"net_flux": 0, "exitance": 1}})", {"'m'", "net_flux 0"});
}

TEST(HeatValues, WithoutAKnownPartOfTheSpectrumAreRefused) {
  const std::string coloured = "newmtl m\nKd 0.5\nnewmtl n\nKd 0.25 0.5 0.5\n";
  expect_heat_refused(coloured, R"({"m": {"temperature": 5}})",
                      {"'m'", "'n'", "red, green and blue"});
  expect_heat_refused(coloured, R"({"m": {"net_flux": 0}})", {"'m'", "net flux"});
  expect_heat_refused(coloured, R"({"bands": ["a", "b"]})", {"'n'", "[0.25, 0.5, 0.5]", "2 bands"});
  expect_heat_refused(grey, R"({"bands": ["a", "b"], "m": {"temperature": 5}})",
                      {"'m'", "'a'", "wavelengths_um"});
  expect_heat_refused("newmtl m\nnewmtl n\nKd 0.25\n",
                      R"({"bands": [{"name": "a", "wavelengths_um": [0, 2]}, {"name": "b",
                 "wavelengths_um": [2, null]}], "m": {"net_flux": 0}})",
                      {"'m'", "net flux", "no emissivity", "2 bands"});
}

TEST(HeatValues, MoreBandsThanChannelsStandBesideTheScene) {
  const SceneFile file = read_heat(grey, R"({"bands": ["a", "b", "c", "d"],
    "m": {"emissivity": [0.1, 0.2, 0.3, 0.4], "exitance": [1, 2, 3, 4]}})");
  const HeatMaterial &m = file.heat.materials.at(0), &n = file.heat.materials.at(1);
  EXPECT_TRUE(m.exitance.isApprox(Eigen::Array4d(1, 2, 3, 4)));
  EXPECT_TRUE(m.rho.isApprox(Eigen::Array4d(.9, .8, .7, .6)));
  EXPECT_TRUE(n.rho.isApprox(Eigen::Array4d::Constant(0.25)));
  EXPECT_TRUE((file.scene.materials.at(0).exitance == 10).all()) << "their sum";
  EXPECT_NEAR(file.scene.materials[0].rho[2], 0.75, 1e-12) << "their mean";
}

TEST(HeatValues, BandsThatMakeNoSenseAreRefused) {
  const auto refuse = [](const std::string& bands, const std::vector<std::string>& parts) {
    expect_heat_refused(grey, "{\"bands\": " + bands + "}", parts);
  };
  refuse("[]", {"'bands'", "0 entries"});
  std::string many = "[0";
  for (int k = 1; k < 1001; ++k) many += ", " + std::to_string(k);
  refuse(many + "]", {"1001 entries", "1 to 1000"});
  refuse(R"(["a", "a"])", {"'a' twice"});
  refuse(R"([7])", {"band 1", "name"});
  refuse(R"([{"name": "a", "wavelengths_um": [3, 2]}])", {"two rising numbers"});
  refuse(R"([{"name": "a", "wavelengths_um": [0, 3]}, {"name": "b", "wavelengths_um": [2, 4]}])",
         {"'a' and 'b' overlap"});
}

TEST(HeatValues, AGroupWithoutFacesIsNamed) {
  const test::TempDir folder;
  const auto file = folder.write("scene.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng lid\ng a\nf 1 2 3\n");
  const auto heat = folder.write("heat.json", R"({"lid": {"temperature": 300}})");
  test::expect_error([&] { read_scene(file, heat); }, ErrorCode::invalid_input,
                     {"heat.json", "'lid'", "has no faces"});
}

}  // namespace
}  // namespace halfshade
