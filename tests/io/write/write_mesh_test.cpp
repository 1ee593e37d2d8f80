#include "io/write/write_mesh.h"

#include "io/write/write_curves.h"
#include "io/write/write_report.h"
#include "tests/support/files.h"
#include "tests/support/hand_made_curves.h"
#include "tests/support/sample_result.h"
#include "tests/support/vtk_structure.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <vtkCellData.h>

#include <array>
#include <sstream>
#include <string>

namespace halfshade {
namespace {

namespace fs = std::filesystem;
using test::numbers;
using Numbers = std::vector<double>;

/// The unit square of sample_result as if two sources had been meshed for.
MeshResult sample_mesh(int n) {
  const SolveResult solved = test::sample_result(n);
  MeshResult result;
  result.scene = solved.scene;
  result.scene.surfaces[0].frame = make_frame(Vec3::Zero(), Vec3::UnitZ());
  result.scene.surfaces[0].rings = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  result.cameras = solved.cameras;
  result.unit = solved.unit;
  result.elements = solved.elements;
  result.stages = {{"mesh", 0.25, 2, ""}};
  result.found.sources = {{0, 7}, {0, 3}};
  result.irradiance_tolerance = 0.125;
  const std::size_t count = result.elements.corners.size();
  for (std::size_t e = 0; e < count; ++e) {
    result.region.push_back(static_cast<Region>(e % 4));
    result.regions.push_back(static_cast<Region>(e % 3));
    result.regions.push_back(Region::umbra);
    const int e3 = static_cast<int>(e % 3);
    result.elements.edge_order.push_back({-1, e3, 2});
  }
  return result;
}

class WriteMesh : public testing::TestWithParam<const char*> {
 protected:
  fs::path write(const MeshResult& result) {
    const fs::path path = folder_.path() / (std::string("m") + GetParam());
    write_mesh(result, {"1.2.3", "halfshade mesh <a>"}, path);
    return path;
  }
  test::TempDir folder_;
};

TEST_P(WriteMesh, AnotherReaderFindsMeshAndRegions) {
  const MeshResult result = sample_mesh(2);
  const auto grid = test::read_vtk(write(result));
  ASSERT_EQ(grid->GetNumberOfPoints(), 9);
  ASSERT_EQ(grid->GetNumberOfCells(), 8);
  vtkFieldData* cells = grid->GetCellData();
  EXPECT_EQ(numbers(cells, "region"), (Numbers{0, 1, 2, 3, 0, 1, 2, 3}));
  EXPECT_EQ(numbers(cells, "regions", 2),
            (Numbers{0, 2, 1, 2, 2, 2, 0, 2, 1, 2, 2, 2, 0, 2, 1, 2}));
  EXPECT_EQ(numbers(cells, "edge_order", 3), (Numbers{-1, 0, 2, -1, 1, 2, -1, 2, 2, -1, 0, 2,
                                                      -1, 1, 2, -1, 2, 2, -1, 0, 2, -1, 1, 2}));
  EXPECT_EQ(numbers(cells, "level"), Numbers(8, 3));
  EXPECT_EQ(numbers(cells, "face"), (Numbers{0, 1, 0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(numbers(cells, "group"), (Numbers{0, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(numbers(cells, "material"), (Numbers{1, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(numbers(cells, "surface"), Numbers(8, 0));
  for (const double angle : numbers(cells, "quality")) EXPECT_NEAR(angle, 45, 1e-12);
  const Numbers exitance = numbers(cells, "exitance", 3), rho = numbers(cells, "reflectance", 3);
  EXPECT_EQ(Numbers(exitance.begin(), exitance.begin() + 6), (Numbers{9, 8, 7, 0, 0, 0}));
  EXPECT_EQ(Numbers(rho.begin(), rho.begin() + 6), (Numbers{0.1, 0.1, 0.1, 0.5, 0.4, 0.3}));
  EXPECT_EQ(cells->GetArray("radiosity"), nullptr) << "nothing was solved";
}

TEST_P(WriteMesh, TheFileSaysHowItCameAbout) {
  MeshResult result = sample_mesh(1);
  result.interrupted = true;
  const auto grid = test::read_vtk(write(result));
  vtkFieldData* field = grid->GetFieldData();
  test::expect_sound_vtk(write(result));
  EXPECT_EQ(numbers(field, "sources"), (Numbers{0, 0}));
  EXPECT_EQ(numbers(field, "source_exitance"), (Numbers{7, 3}));
  EXPECT_EQ(numbers(field, "irradiance_tolerance"), Numbers{0.125});
  EXPECT_EQ(numbers(field, "interrupted"), Numbers{1});
}

TEST_P(WriteMesh, ThereIsAFileWithoutElementsToo) {
  EXPECT_EQ(test::read_vtk(write(sample_mesh(0)))->GetNumberOfCells(), 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, WriteMesh, testing::Values(".vtu", ".vtp"),
                         [](const auto& test) { return std::string(test.param + 1); });

TEST(WriteMeshPly, HoldsEveryCoordinateToTheLastBit) {
  const test::TempDir folder;
  MeshResult result = sample_mesh(1);
  result.elements.points[2] = {1.0 / 3, -1e60, 1e-300};
  write_mesh(result, {"1", "two\nlines"}, folder.path() / "m.ply");
  const std::string bytes = test::contents(folder.path() / "m.ply");
  EXPECT_NE(bytes.find("comment command line: two lines\n"), std::string::npos);
  EXPECT_NE(bytes.find("element vertex 4\n"), std::string::npos);
  EXPECT_NE(bytes.find("element face 2\n"), std::string::npos);
  std::istringstream body(bytes.substr(bytes.find("end_header\n") + 11));
  for (const Vec3& expected : result.elements.points) {
    std::string x, y, z;
    body >> x >> y >> z;
    EXPECT_EQ(Vec3(std::stod(x), std::stod(y), std::stod(z)), expected);
  }
  for (std::size_t e = 0; e < 2; ++e) {
    int count = 0, a = 0, b = 0, c = 0, surface = 0, region = 0;
    body >> count >> a >> b >> c >> surface >> region;
    EXPECT_EQ(count, 3);
    EXPECT_EQ((std::array{a, b, c}), result.elements.corners[e]);
    EXPECT_EQ(surface, result.elements.surface[e]);
    EXPECT_EQ(region, static_cast<int>(result.region[e]));
  }
  EXPECT_TRUE(body.good() && body.get() == '\n' && body.peek() == EOF);
}

TEST(WriteMeshErrors, RefusesWhatItCannotWrite) {
  const test::TempDir folder;
  test::expect_error([&] { write_mesh(sample_mesh(1), {}, folder.path() / "m.obj"); },
                     ErrorCode::usage, {"m.obj", ".vtu, .vtp or .ply"});
  test::expect_error([&] { write_mesh(sample_mesh(1), {}, folder.path() / "none" / "m.vtu"); },
                     ErrorCode::unwritable, {"none"});
  MeshResult unlabelled = sample_mesh(2), dangling = sample_mesh(2);
  unlabelled.regions.pop_back();
  dangling.elements.corners[1][2] = 9;
  for (const MeshResult& result : {unlabelled, dangling})
    test::expect_error([&] { write_mesh(result, {}, folder.path() / "m.vtu"); },
                       ErrorCode::contract, {"write_mesh"});
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(MeshReport, CountsCurvesByKindAndOrder) {
  const test::TempDir folder;
  MeshResult result = sample_mesh(2);
  result.found.curves = test::hand_made_curves().curves;
  result.found.report.found = {1, 0, 4, 2};
  result.found.report.merged = 4;
  result.mesh = {2, 1, 1e-9, 3, 0};
  write_report(result, {{"1.2.3", "mesh"}, {"m.vtu"}}, folder.path() / "r.json");
  const auto json = nlohmann::json::parse(test::contents(folder.path() / "r.json"));
  const auto& curves = json.at("curves");
  EXPECT_EQ(curves.at("total"), 3);
  EXPECT_EQ(curves.at("by_kind").at("ev").at("count"), 1);
  EXPECT_EQ(curves.at("by_kind").at("contact").at("length"), 0.75);
  EXPECT_NEAR(curves.at("by_order").at("D2").at("length").get<double>(), M_PI / 2, 1e-4);
  EXPECT_EQ(curves.at("by_order").at("D0").at("count"), 1);
  EXPECT_EQ(json.at("search").at("found").at("eee"), 2);
  EXPECT_EQ(json.at("search").at("merged"), 4);
  EXPECT_EQ(json.at("sources").at(0).at("exitance_w_per_m2"), 7);
  EXPECT_EQ(json.at("sources").at(0).at("area"), 1);
  const auto& mesh = json.at("mesh");
  EXPECT_EQ(mesh.at("elements"), 8);
  EXPECT_EQ(mesh.at("kept"), 2);
  EXPECT_EQ(mesh.at("culled"), 1);
  EXPECT_NEAR(mesh.at("min_angle_degrees").get<double>(), 45, 1e-12);
  EXPECT_EQ(mesh.at("irradiance_tolerance_w_per_m2"), 0.125);
  EXPECT_NEAR(mesh.at("area_quality").at("histogram").at("shares").at(8).get<double>() +
                  mesh.at("area_quality").at("histogram").at("shares").at(9).get<double>(),
              1, 1e-12)
      << "halves of squares: 45 degrees, this side of it or that";
  EXPECT_EQ(json.at("stages").at(0).at("name"), "mesh");
  EXPECT_EQ(json.at("outputs"), nlohmann::json({"m.vtu"}));
}

}  // namespace
}  // namespace halfshade
