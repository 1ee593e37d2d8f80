#include "io/read/read_points.h"

#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <fstream>

namespace halfshade {
namespace {

class Points : public testing::Test {
 protected:
  PointTable read(const std::string& text) {
    std::ofstream(file(), std::ios::binary) << text;
    return read_points(file());
  }
  std::filesystem::path file() const { return folder_.path() / "p.csv"; }
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  test::TempDir folder_;
};

TEST_F(Points, ReadColumnsByName) {
  const PointTable table = read("name,NZ,ny,nx,z,y,x\nfirst,1,0,0,3,2,1\nsecond,0,0,1,6,5,4\n");
  ASSERT_EQ(table.points.size(), 2u);
  EXPECT_EQ(table.points[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(table.points[0].normal, Vec3(0, 0, 1));
  EXPECT_EQ(table.points[1].position, Vec3(4, 5, 6));
  EXPECT_EQ(table.points[1].normal, Vec3(1, 0, 0));
  EXPECT_EQ(table.header, "name,NZ,ny,nx,z,y,x");
  EXPECT_EQ(table.rows[1], "second,0,0,1,6,5,4");
}

TEST_F(Points, ReadSixColumnsWithoutNames) {
  for (const std::string separator : {",", ";", "\t", " , "}) {
    std::string text;
    for (const char* value : {"1", "-2.5", "3e-1", "0", "+0", "2"})
      text += (text.empty() ? "" : separator) + std::string(value);
    const PointTable table = read(text + "\r\n\r\n# a comment\r\n" + text);
    ASSERT_EQ(table.points.size(), 2u) << text;
    EXPECT_EQ(table.points[0].position, Vec3(1, -2.5, 0.3));
    EXPECT_EQ(table.points[1].normal, Vec3(0, 0, 1)) << "normals need not be of unit length";
  }
}

TEST_F(Points, ReadBackWhatAGridWrote) {
  const Vec3 normal = Vec3(1, 2, 3).normalized();
  const PointTable table =
      point_table({{{0.1, 1. / 3, 1e-300}, normal}, {{-0.7, 1e17, 5}, normal}});
  const PointTable again = read(table.header + "\n" + table.rows[0] + "\n" + table.rows[1] + "\n");
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(again.points[k].position, table.points[k].position);
    EXPECT_EQ(again.points[k].normal, table.points[k].normal);
  }
}

TEST_F(Points, RefuseTablesThatMakeNoSense) {
  const auto refuse = [&](const std::string& text, const std::vector<std::string>& parts) {
    test::expect_error([&] { read(text); }, ErrorCode::invalid_input, parts);
  };
  refuse("", {"p.csv"});
  refuse("x,y,z,nx,ny,nz\n", {"p.csv", "no points"});
  refuse("x,y,z,nx,ny\n1,2,3,0,0\n", {"p.csv:1", "'nz'", "missing"});
  refuse("x,y,z,nx,ny,nz,X\n1,2,3,0,0,1,2\n", {"p.csv:1", "'x'", "more than once"});
  refuse("1,2,3,0,0\n", {"p.csv:1", "six", "5"});
  refuse("1,2,3,0,0,1,7\n", {"p.csv:1", "six", "7"});
  refuse("x,y,z,nx,ny,nz\n1,2,3,0,0,1\n1,2,3,0,0\n", {"p.csv:3", "5 columns", "6"});
  refuse("x,y,z,nx,ny,nz\n1,2,3,0,0,one\n", {"p.csv:2", "'one'"});
  refuse("x,y,z,nx,ny,nz\n1,2,,0,0,1\n", {"p.csv:2"});
  refuse("x,y,z,nx,ny,nz\n1,nan,3,0,0,1\n", {"p.csv:2", "nan"});
  refuse("1,2,3,0,0,inf\n", {"p.csv:1", "inf"});
  refuse("x,y,z,nx,ny,nz\n1,2,3,0,0,1\n1,2,3,0,0,0\n", {"p.csv:3", "point 2", "length zero"});
  test::expect_error([&] { read_points(folder() / "none.csv"); }, ErrorCode::invalid_input,
                     {"none.csv"});
}

}  // namespace
}  // namespace halfshade
