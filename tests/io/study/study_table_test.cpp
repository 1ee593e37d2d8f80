#include "io/study/study_table.h"

#include "tests/support/expect_error.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

StudyRow some_row() {
  StudyRow row;
  row.one = {"matrix", 0.03};
  row.seconds = 1.5;
  row.cpu_seconds = 2.25;
  row.process_seconds = 1. / 3;
  row.peak_memory_bytes = 123456789;
  row.elements = 1000;
  row.unknowns = 3000;
  row.estimated = 0.02;
  row.total = {0.01, 0.1};
  row.direct = {0.007, 0.08};
  row.stages = "mesh 0.1/0.2; direct light 1/2";
  return row;
}

TEST(StudyTable, ComesBackAsItWas) {
  const test::TempDir folder;
  StudyRow slow;
  slow.one = {"fields", 1e-4};
  slow.end = CaseEnd::time_limit;
  slow.note = "ended, after # 60 s";
  StudyRow loose = some_row();
  loose.one.tolerance = 0.1;
  write_study({some_row(), slow, loose}, "key, of it", folder.path() / "s.csv");
  const auto rows = read_study("key, of it", folder.path() / "s.csv");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].one, slow.one) << "in the order of the methods";
  EXPECT_EQ(rows[1].one, loose.one) << "loose tolerances first";
  EXPECT_EQ(rows[0].end, CaseEnd::time_limit);
  EXPECT_EQ(rows[0].note, "ended; after   60 s");
  EXPECT_FALSE(has_result(rows[0]));
  const StudyRow &row = rows[2], want = some_row();
  EXPECT_EQ(row.process_seconds, want.process_seconds);
  EXPECT_EQ(row.peak_memory_bytes, want.peak_memory_bytes);
  EXPECT_EQ(row.unknowns, want.unknowns);
  EXPECT_EQ(row.direct.max, want.direct.max);
  EXPECT_TRUE(std::isnan(row.reflected.l2));
  EXPECT_EQ(row.effectivity(), 2);
  EXPECT_EQ(row.stages, want.stages);
  const std::string bytes = test::contents(folder.path() / "s.csv");
  write_study(rows, "key, of it", folder.path() / "s.csv");
  EXPECT_EQ(test::contents(folder.path() / "s.csv"), bytes);
}

TEST(StudyTable, IsRefusedIfItIsAnotherOne) {
  const test::TempDir folder;
  const auto path = folder.path() / "s.csv";
  write_study({some_row()}, "one", path);
  test::expect_error([&] { read_study("other", path); }, ErrorCode::usage, {"another study"});
  folder.write("t.csv", "# one\na,b\n1,2\n");
  test::expect_error([&] { read_study("one", folder.path() / "t.csv"); }, ErrorCode::invalid_input,
                     {"columns"});
  folder.write("u.csv", "# one\na,b\n1\n");
  test::expect_error([&] { read_table(folder.path() / "u.csv"); }, ErrorCode::invalid_input,
                     {"u.csv:3", "1 cells"});
  std::string text = test::contents(path);
  text.replace(text.find("0.03"), 4, "x.03");
  folder.write("v.csv", text);
  test::expect_error([&] { read_study("one", folder.path() / "v.csv"); }, ErrorCode::invalid_input,
                     {"x.03"});
}

}  // namespace
}  // namespace halfshade
