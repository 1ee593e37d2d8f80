#include "io/write/write_points.h"

#include "tests/support/files.h"
#include "tests/support/vtk_structure.h"

#include <gtest/gtest.h>
#include <vtkPointData.h>

#include <algorithm>

namespace halfshade {
namespace {

std::vector<DirectLight> some_light() {
  DirectLight a, b;
  a.irradiance = {1. / 3, 0, 2e-7};
  a.visible = 0.1;
  a.region = Region::penumbra;
  b.irradiance = {1, 2, 3};
  return {a, b};
}

TEST(WritePoints, WithAllDigitsBesideTheirRows) {
  const test::TempDir folder;
  const PointTable table =
      read_points(folder.write("p.csv", "id;x;y;z;nx;ny;nz\na b;1;2;3;0;0;2\nc;1;2;4;0;0;2\n"));
  write_points(table, some_light(), folder.path() / "o.csv");
  EXPECT_EQ(test::contents(folder.path() / "o.csv"),
            "id;x;y;z;nx;ny;nz;H_r;H_g;H_b;visible\n"
            "a b;1;2;3;0;0;2;0.3333333333333333;0;2e-07;0.1\n"
            "c;1;2;4;0;0;2;1;2;3;1\n");
}

TEST(WritePoints, LeavesOutThoseNotReached) {
  const test::TempDir folder;
  const PointTable table = point_table({{{1, 2, 3}, Vec3::UnitZ()}, {{4, 5, 6}, Vec3::UnitZ()}});
  const std::vector<DirectLight> light = some_light();
  write_points(table, std::span(light).first(1), folder.path() / "o.csv");
  const std::string text = test::contents(folder.path() / "o.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), "# interrupted: 1 of 2 points");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3) << "the comment, the header, a row";
  EXPECT_EQ(read_points(folder.path() / "o.csv").points.size(), 1U) << "it can be read back";
  write_points(table, std::span(light).first(1), folder.path() / "o.vtp");
  write_points(table, light, folder.path() / "all.vtp");
  const auto interrupted = [&](const char* name) {
    const auto grid = test::read_vtk(folder.path() / name);
    return test::numbers(grid->GetFieldData(), "interrupted").at(0);
  };
  EXPECT_EQ(interrupted("o.vtp"), 1);
  EXPECT_EQ(interrupted("all.vtp"), 0);
}

TEST(WritePoints, ForParaView) {
  const test::TempDir folder;
  const PointTable table = point_table({{{1, 2, 0.1}, Vec3::UnitZ()}, {{4, 5, 6}, Vec3::UnitX()}});
  write_points(table, some_light(), folder.path() / "o.vtp");
  test::expect_sound_vtk(folder.path() / "o.vtp");
  const auto grid = test::read_vtk(folder.path() / "o.vtp");
  ASSERT_EQ(grid->GetNumberOfPoints(), 2);
  EXPECT_EQ(vtkPolyData::SafeDownCast(grid)->GetNumberOfVerts(), 2);
  EXPECT_EQ(grid->GetPoint(0)[2], 0.1);
  EXPECT_EQ(grid->GetPointData()->GetArray("irradiance")->GetComponent(0, 0), 1. / 3);
  EXPECT_EQ(grid->GetPointData()->GetArray("visible")->GetComponent(0, 0), 0.1);
  EXPECT_EQ(grid->GetPointData()->GetArray("region")->GetComponent(0, 0), 1);
  EXPECT_EQ(grid->GetPointData()->GetArray("normal")->GetComponent(1, 0), 1);
}

TEST(WritePoints, RefusesUnknownPlaces) {
  const test::TempDir folder;
  const PointTable table = point_table({{{1, 2, 3}, Vec3::UnitZ()}, {{4, 5, 6}, Vec3::UnitZ()}});
  test::expect_error([&] { write_points(table, some_light(), folder.path() / "o.txt"); },
                     ErrorCode::usage, {"o.txt", ".csv"});
  test::expect_error([&] { write_points(table, some_light(), folder.path() / "none" / "o.csv"); },
                     ErrorCode::unwritable, {"o.csv"});
  EXPECT_TRUE(has_format("a.vtp", point_formats));
  EXPECT_FALSE(has_format("a.vtu", point_formats));
}

}  // namespace
}  // namespace halfshade
