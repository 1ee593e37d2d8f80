#include "io/read/read_factors.h"

#include "tests/support/files.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

const std::string names =
    "# halfshade\nsurface,area,space,row_sum,error\nface "
    "1,2,0.75,1,1e-9\n\"a,\"\"b\"\"\",1,0.5,1,0\n";
const std::string matrix =
    "%%MatrixMarket matrix coordinate real general\n% areas in m²\n2 2 2\n1 2 0.25\n2 1 0.5\n";

FactorMatrix read(const std::string& matrix_text, const std::string& names_text) {
  const test::TempDir folder;
  folder.write("f.names.csv", names_text);
  return read_factors(folder.write("f.mtx", matrix_text));
}

TEST(ReadFactors, ReadsWhatIsWritten) {
  const FactorMatrix factors = read(matrix, names);
  EXPECT_EQ(factors.names, (std::vector<std::string>{"face 1", "a,\"b\""}));
  EXPECT_EQ(factors.area[0], 2);
  EXPECT_EQ(factors.factors(0, 1), 0.25);
  EXPECT_EQ(factors.factors(1, 0), 0.5);
  EXPECT_EQ(factors.factors(1, 1), 0);
  EXPECT_EQ(factors.space[1], 0.5);
  EXPECT_EQ(factors.error[0], 1e-9);
  EXPECT_EQ(factors.source.substr(factors.source.size() - 5), "f.mtx");
}

TEST(ReadFactors, TellsWhatTheFileTells) {
  EXPECT_TRUE(read(matrix, names).places.empty());
  EXPECT_EQ(read(matrix, names).left_out.size(), 0);
  const FactorMatrix factors = read(
      matrix,
      "surface,area,space,row_sum,error,note,left_out,centre_x,centre_y,centre_z,normal_x,normal_y,"
      "normal_z,extent_x,extent_y,extent_z\n"
      "face 1,2,0.5,1,1e-9,hot,0.25,1,2,3,0,0,1,2,1,0\nface "
      "2,1,0.5,1,0,cold,0,4,5,6,0,0,-1,1,1,0\n");
  ASSERT_EQ(factors.left_out.size(), 2);
  EXPECT_EQ(factors.left_out[0], 0.25);
  ASSERT_EQ(factors.places.size(), 2U);
  EXPECT_EQ(factors.places[1].centre, Vec3(4, 5, 6));
  EXPECT_EQ(factors.places[1].normal, Vec3(0, 0, -1));
  EXPECT_EQ(factors.places[0].extent, Vec3(2, 1, 0));
}

TEST(ReadFactors, RefusesRowsThatDoNotAddUp) {
  const std::string head = "%%MatrixMarket matrix coordinate real general\n2 2 2\n";
  const auto refuse = [&](const std::string& entries, const std::string& first_row,
                          const std::vector<std::string>& parts) {
    SCOPED_TRACE(entries + first_row);
    test::expect_error(
        [&] {
          read(head + entries,
               "surface,area,space,row_sum,error\n" + first_row + "\nface 2,2,0.75,1,1e-9\n");
        },
        ErrorCode::invalid_input, parts);
  };
  const std::string good = "1 2 0.25\n2 1 0.25\n";
  refuse("1 2 0.375\n2 1 0.375\n", "face 1,2,0.75,1,1e-9", {"'face 1'", "add up to 1.125"});
  refuse("1 2 .25025\n2 1 .25025\n", "face 1,2,0.75,1,1e-9", {"add up to 1.00025", "as 1;"});
  refuse("1 2 0.125\n2 1 0.125\n", "face 1,2,0.75,1,1e-3", {"add up to 0.875"});
  refuse("1 2 -0.25\n2 1 -0.25\n", "face 1,2,1.25,1,1e-3",
         {"from 'face 1' to 'face 2' is -0.25", "negative"});
  refuse(good, "face 1,2,-0.25,0,1e-3", {"'face 1'", "space", "negative"});
  refuse(good, "face 1,2,1,1.25,1e-3", {"'face 1'", "1.25 instead of 1", "0.003"});
  refuse(good, "face 1,2,0.5,0.75,1e-3", {"'face 1'", "0.75 instead of 1"});
}

TEST(ReadFactors, TakesRowsThatWereEnforcedOrMadeSparse) {
  const std::string head = "surface,area,space,row_sum,error";
  EXPECT_NO_THROW(read(matrix, head + "\nface 1,2,.75,.998,1e-3\nface 2,1,.5,1.001,1e-3\n"));
  // Without a column for it, what is missing may have been left out, each zero up to the error.
  EXPECT_NO_THROW(read(matrix, head + "\nface 1,2,.74,1,.01\nface 2,1,.49,1,.01\n"));
  EXPECT_NO_THROW(
      read(matrix, head + ",left_out\nface 1,2,.74,1,.01,.01\nface 2,1,.49,1,.01,.01\n"));
  test::expect_error(
      [&] { read(matrix, head + ",left_out\nface 1,2,.74,1,.01,0\nface 2,1,.5,1,.01,0\n"); },
      ErrorCode::invalid_input, {"'face 1'", "0.99"});
}

TEST(ReadFactors, RefusesWhatIsNoMatrixOfFormFactors) {
  const auto refuse = [](const std::string& matrix_text, const std::string& names_text,
                         const std::vector<std::string>& parts) {
    SCOPED_TRACE(matrix_text + names_text);
    test::expect_error([&] { read(matrix_text, names_text); }, ErrorCode::invalid_input, parts);
  };
  const std::string head = "%%MatrixMarket matrix coordinate real general\n";
  refuse("1 2 3\n", names, {"f.mtx:1", "MatrixMarket"});
  refuse(head + "3 3 0\n", names, {"f.mtx:2", "3 by 3", "2 rows"});
  refuse(head + "2 2 2\n1 2 0.5\n", names, {"ends before"});
  refuse(head + "2 2 1\n1 2 0.5\n1 1 0.5\n", names, {"f.mtx:4", "more entries"});
  refuse(head + "2 2 1\n1 3 0.5\n", names, {"(1, 3)", "2 rows"});
  refuse(head + "2 2 1\n1 2 9\n", names, {"form factor is 9"});
  refuse(head + "2 2 1\n1 2 nan\n", names, {"form factor is nan"});
  refuse(head + "2 2 2\n1 2 .5\n1 2 .5\n", names, {"twice"});
  refuse(head + "2 2 1\n1 2\n", names, {"2 words"});
  refuse(matrix, "surface,area\n", {"f.names.csv:1", "row_sum"});
  refuse(matrix, "surface,area,space,row_sum,error\nface 1,-1,0,1,0\n", {"area is -1"});
  refuse(matrix, "surface,area,space,row_sum,error\nface 1,0,0,1,0\n", {"area is 0"});
  refuse(matrix, "surface,area,space,row_sum,error\nface 1,1,0\n", {"3 cells"});
  refuse(matrix, "surface,area,space,row_sum,error\n", {"no rows"});
  const test::TempDir folder;
  const auto alone = folder.write("f.mtx", matrix);
  test::expect_error([&] { read_factors(alone); }, ErrorCode::invalid_input, {"f.names.csv"});
  test::expect_error([&] { read_factors(folder.path() / "f.csv"); }, ErrorCode::usage, {".mtx"});
}

}  // namespace
}  // namespace halfshade
