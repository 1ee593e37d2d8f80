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
