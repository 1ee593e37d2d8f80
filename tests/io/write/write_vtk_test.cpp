#include "io/picture/picture.h"
#include "io/write/write_result.h"
#include "tests/support/files.h"
#include "tests/support/sample_result.h"
#include "tests/support/vtk_structure.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <cmath>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

vtkSmartPointer<vtkPointSet> read(const fs::path& path) { return test::read_vtk(path); }

void expect_channels(vtkFieldData* data, const char* name, const ChannelArray& values) {
  vtkDataArray* array = data->GetArray(name);
  ASSERT_NE(array, nullptr) << name;
  EXPECT_EQ(array->GetDataType(), VTK_DOUBLE) << name;
  ASSERT_EQ(array->GetNumberOfComponents(), 3) << name;
  ASSERT_EQ(array->GetNumberOfTuples(), values.rows()) << name;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (int c = 0; c < 3; ++c) ASSERT_EQ(array->GetComponent(i, c), values(i, c)) << name;
}

void expect_integers(vtkFieldData* data, const char* name, const std::vector<int>& values) {
  vtkDataArray* array = data->GetArray(name);
  ASSERT_NE(array, nullptr) << name;
  ASSERT_EQ(array->GetNumberOfComponents(), 1) << name;
  ASSERT_EQ(array->GetNumberOfTuples(), static_cast<vtkIdType>(values.size())) << name;
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_EQ(array->GetComponent(static_cast<vtkIdType>(i), 0), values[i]) << name;
}

void expect_numbers(vtkFieldData* data, const char* name, const std::vector<double>& expected) {
  vtkDataArray* array = data->GetArray(name);
  ASSERT_NE(array, nullptr) << name;
  ASSERT_EQ(array->GetNumberOfTuples(), static_cast<vtkIdType>(expected.size())) << name;
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(array->GetTuple1(static_cast<vtkIdType>(i)), expected[i]) << name << ' ' << i;
}

class WriteVtk : public testing::TestWithParam<const char*> {
 protected:
  fs::path write(const SolveResult& result) {
    const fs::path path = folder_.path() / (std::string("out") + GetParam());
    write_result(result, {"1.2.3", "halfshade solve \"a <scene> & more.obj\""}, path);
    return path;
  }

  test::TempDir folder_;
};

TEST_P(WriteVtk, AnotherReaderFindsTheSameMeshToTheLastBit) {
  SolveResult result = test::sample_result(3);
  result.elements.points[4] = {1.0 / 3, -1e60, 1e-300};
  const auto grid = read(write(result));
  ASSERT_EQ(grid->GetNumberOfPoints(), 16);
  ASSERT_EQ(grid->GetNumberOfCells(), 18);
  for (vtkIdType i = 0; i < 16; ++i)
    EXPECT_EQ(Vec3(grid->GetPoint(i)), result.elements.points[static_cast<std::size_t>(i)]);
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < 18; ++i) {
    EXPECT_EQ(grid->GetCellType(i), VTK_TRIANGLE);
    grid->GetCellPoints(i, ids);
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(ids->GetId(k),
                result.elements.corners[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]);
  }
}

TEST_P(WriteVtk, AnotherReaderFindsTheSameLightToTheLastBit) {
  const SolveResult result = test::sample_result(3);
  const auto grid = read(write(result));
  vtkFieldData* cells = grid->GetCellData();
  expect_channels(cells, "radiosity", result.solution.radiosity);
  expect_channels(cells, "irradiance", result.solution.irradiance);
  expect_channels(cells, "direct_irradiance", result.solution.direct_irradiance);
  expect_channels(cells, "exitance", result.solution.exitance);
  expect_channels(cells, "reflectance", result.solution.rho);
  const Eigen::ArrayXd& error = result.solution.error_estimate;
  expect_numbers(cells, "error_estimate", {error.begin(), error.end()});
  expect_integers(cells, "order", std::vector<int>(18, 0));
  expect_integers(cells, "region", {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1});
  expect_integers(cells, "face", result.elements.face);
  expect_integers(cells, "group", result.elements.group);
  expect_integers(cells, "material", result.elements.material);
  expect_integers(cells, "surface", result.elements.surface);
  expect_integers(cells, "level", result.elements.level);
  for (vtkIdType i = 0; i < 18; ++i)  // halves of squares
    EXPECT_NEAR(cells->GetArray("quality")->GetComponent(i, 0), 45, 1e-12);
  // The corner (1, 0) belongs to one element, number 4; equal areas meet at the others.
  for (const char* name : {"radiosity", "irradiance"}) {
    const ChannelArray& values =
        name[0] == 'r' ? result.solution.radiosity : result.solution.irradiance;
    vtkDataArray* array = grid->GetPointData()->GetArray(name);
    ASSERT_NE(array, nullptr);
    ASSERT_EQ(array->GetNumberOfTuples(), 16);
    for (int c = 0; c < 3; ++c) {
      EXPECT_DOUBLE_EQ(array->GetComponent(3, c), values(4, c));
      EXPECT_DOUBLE_EQ(array->GetComponent(0, c), (values(0, c) + values(1, c)) / 2);
    }
  }
}

TEST_P(WriteVtk, RegionsOfEachEmitterAreThereIfAskedFor) {
  SolveResult result = test::sample_result(1);
  EXPECT_EQ(read(write(result))->GetCellData()->GetArray("regions"), nullptr);
  result.emitters = {{0, 7}, {0, 3}};
  result.regions = {Region::lit, Region::umbra, Region::penumbra, Region::away};
  const auto grid = read(write(result));
  EXPECT_EQ(test::numbers(grid->GetCellData(), "regions", 2), (std::vector<double>{0, 2, 1, 3}));
  EXPECT_EQ(test::numbers(grid->GetFieldData(), "source_exitance"), (std::vector<double>{7, 3}));
  result.regions.pop_back();
  test::expect_error([&] { write(result); }, ErrorCode::contract, {"2 emitters have 3 regions"});
}

TEST_P(WriteVtk, NetFluxesAndTemperaturesAreThereWhereHeatIsGiven) {
  SolveResult result = test::sample_result(2);
  EXPECT_EQ(read(write(result))->GetCellData()->GetArray("net_flux"), nullptr);
  result.heat.is_given = true;
  const auto without = read(write(result));
  expect_channels(without->GetCellData(), "net_flux",
                  result.solution.radiosity - result.solution.irradiance);
  EXPECT_EQ(without->GetCellData()->GetArray("temperature"), nullptr);
  result.heat.materials.resize(result.scene.materials.size());
  const int material = result.elements.material[0];
  result.heat.materials[static_cast<std::size_t>(material)].temperature = 321.5;
  const auto with = read(write(result));
  vtkDataArray* kelvin = with->GetCellData()->GetArray("temperature");
  ASSERT_NE(kelvin, nullptr);
  EXPECT_EQ(kelvin->GetTuple1(0), 321.5);
  EXPECT_TRUE(std::isnan(kelvin->GetTuple1(1))) << "of a material without one";
}

TEST_P(WriteVtk, MoreBandsThanChannelsStandBesideTheirSums) {
  SolveResult result = test::sample_result(1);
  const auto rows = result.solution.irradiance.rows();
  result.heat.is_given = true;
  result.heat.bands.resize(4);
  EXPECT_EQ(read(write(result))->GetCellData()->GetArray("net_flux_by_band"), nullptr);
  result.solution.band_radiosity = Eigen::ArrayXXd::Random(rows, 4);
  result.solution.band_irradiance = Eigen::ArrayXXd::Random(rows, 4);
  const auto grid = read(write(result));
  for (int k = 0; k < 4; ++k) {
    const double net = result.solution.band_radiosity(1, k) - result.solution.band_irradiance(1, k);
    EXPECT_EQ(grid->GetCellData()->GetArray("net_flux_by_band")->GetComponent(1, k), net);
    EXPECT_EQ(grid->GetCellData()->GetArray("radiosity_by_band")->GetComponent(1, k),
              result.solution.band_radiosity(1, k));
  }
}

TEST_P(WriteVtk, TheFileSaysHowItCameAbout) {
  SolveResult result = test::sample_result(1);
  result.interrupted = true;
  vtkFieldData* data = nullptr;
  const auto grid = read(write(result));
  data = grid->GetFieldData();
  EXPECT_EQ(data->GetArray("interrupted")->GetComponent(0, 0), 1);
  EXPECT_EQ(data->GetArray("achieved_error")->GetNumberOfTuples(), 1);
  const auto camera = test::numbers(data, "cameras", 10);
  EXPECT_EQ(camera, (std::vector<double>{0.5, 0.5, 3, 0, 0, -1, 0, 1, 0, 40}));
  EXPECT_EQ(test::numbers(data, "camera_names"), (std::vector<double>{'a', 'b', 'o', 'v', 'e', 0}));
}

TEST_P(WriteVtk, OtherProgramsFindNumbersOnly) {
  for (const int n : {1, 3}) test::expect_sound_vtk(write(test::sample_result(n)));
}

TEST_P(WriteVtk, WhatDiffersFromRunToRunIsNotInTheFile) {
  SolveResult again = test::sample_result(2);
  for (StageReport& stage : again.stages) stage.seconds += 1;
  const std::string bytes = test::contents(write(test::sample_result(2)));
  EXPECT_EQ(test::contents(write(again)), bytes);
  const fs::path other = folder_.path() / (std::string("other") + GetParam());
  write_result(again, {"1.2.3", "halfshade solve elsewhere"}, other);
  EXPECT_EQ(test::contents(other), bytes);
}

TEST_P(WriteVtk, CameraNamesInAnyEncodingComeThrough) {
  SolveResult result = test::sample_result(1);
  result.cameras.resize(3);
  result.cameras[0].name = "\xff not UTF-8";
  result.cameras[1].name = "";
  result.cameras[2].name = "küche";
  const auto cameras = read_shaded(write(result)).cameras;
  ASSERT_EQ(cameras.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(cameras[k].name, result.cameras[k].name);
}

TEST_P(WriteVtk, DataAreInlineAndCompressed) {
  // ParaView builds with a newer expat read appended data as empty, without an error.
  const std::string text = test::contents(write(test::sample_result(3)));
  EXPECT_NE(text.find("format=\"binary\""), std::string::npos);
  EXPECT_EQ(text.find("format=\"appended\""), std::string::npos);
  EXPECT_EQ(text.find("AppendedData"), std::string::npos);
  EXPECT_NE(text.find("vtkZLibDataCompressor"), std::string::npos);
}

TEST_P(WriteVtk, TheSameResultGivesTheSameBytes) {
  const std::string first = test::contents(write(test::sample_result(8)));
  EXPECT_EQ(first, test::contents(write(test::sample_result(8))));
}

TEST_P(WriteVtk, ExtremeValuesComeThroughInSilence) {
  SolveResult result = test::sample_result(2);
  result.solution.radiosity.setConstant(1e300);  // squares overflow
  result.solution.irradiance.setConstant(5e-324);
  const fs::path path = write(result);
  testing::internal::CaptureStderr();
  const auto grid = read(path);
  expect_channels(grid->GetCellData(), "radiosity", result.solution.radiosity);
  expect_channels(grid->GetCellData(), "irradiance", result.solution.irradiance);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(WriteVtk, AnEmptyMeshIsStillAFile) {
  EXPECT_EQ(read(write(test::sample_result(0)))->GetNumberOfCells(), 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, WriteVtk, testing::Values(".vtu", ".vtp"),
                         [](const auto& test) { return std::string(test.param + 1); });

TEST(WriteResult, KnowsItsExtensions) {
  for (const char* name : {"a.vtu", "b.vtp", "c.ply", "D.VTU"})
    EXPECT_TRUE(has_format(name, result_formats));
  for (const char* name : {"a.obj", "vtu", "", "a.vtu.gz"}) {
    EXPECT_FALSE(has_format(name, result_formats));
    test::expect_error([&] { write_result(test::sample_result(1), {}, name); }, ErrorCode::usage,
                       {name, ".vtu, .vtp or .ply"});
  }
}

TEST(WriteResult, RefusesAPlaceThatCannotBeWritten) {
  const test::TempDir folder;
  for (const char* name : {"a.vtu", "a.vtp", "a.ply"}) {
    const fs::path path = folder.path() / "none" / name;
    test::expect_error([&] { write_result(test::sample_result(1), {}, path); },
                       ErrorCode::unwritable, {path.string(), "No such file or directory"});
  }
}

TEST(WriteResult, RefusesArraysThatDoNotFitTogether) {
  const test::TempDir folder;
  SolveResult shorter = test::sample_result(2);
  shorter.solution.irradiance.conservativeResize(3, 3);
  SolveResult dangling = test::sample_result(2);
  dangling.elements.corners[1][2] = 9;
  SolveResult without = test::sample_result(2);
  without.elements.level.clear();
  for (const SolveResult& result : {shorter, dangling, without})
    test::expect_error([&] { write_result(result, {}, folder.path() / "a.vtu"); },
                       ErrorCode::contract, {"write_result"});
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace halfshade
