#include "tests/architecture/length_rules.h"
#include "tests/support/places.h"

#include <gmock/gmock.h>

namespace halfshade::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Architecture, FilesAreShort) {
  const auto files = sources_of(sources_folder, {"meshing", "solver", "io", "apps", "tests"});
  ASSERT_GE(files.size(), 400u);
  for (const std::string& sentence : too_long(files)) ADD_FAILURE() << sentence;
}

std::string lines(int count) {
  std::string text;
  for (int k = 0; k < count; ++k) text += "// line\n";
  return text;
}

TEST(LengthRules, CountLines) {
  EXPECT_EQ(line_count(""), 0);
  EXPECT_EQ(line_count("\n"), 1);
  EXPECT_EQ(line_count("a\nb\n"), 2);
  EXPECT_EQ(line_count("a\n\nb"), 3);
}

TEST(LengthRules, NameFilesThatAreTooLong) {
  EXPECT_THAT(too_long({{"a/x.h", lines(most_lines)}, {"a/y.h", ""}}), IsEmpty());
  EXPECT_THAT(
      too_long({{"a/x.h", lines(most_lines)}, {"a/y.cpp", lines(most_lines) + "// no end"}}),
      ElementsAre("a/y.cpp has 401 lines, more than 400: split it by subject"));
}

}  // namespace
}  // namespace halfshade::test
