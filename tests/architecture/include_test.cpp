#include "tests/architecture/include_rules.h"
#include "tests/support/places.h"

#include <gmock/gmock.h>

namespace halfshade::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Architecture, IncludesKeepToTheTableOfRooms) {
  const std::filesystem::path root = sources_folder;
  const IncludeRules rules = rules_of(read_whole(root / "ARCHITECTURE.md"));
  ASSERT_GE(rules.size(), 20u);
  const std::vector<SourceText> files = sources_of(root, {"meshing", "solver", "io", "apps"});
  ASSERT_GE(files.size(), 200u);
  for (const std::string& sentence : broken_rules(rules, files)) ADD_FAILURE() << sentence;
}

const IncludeRules small_rules = rules_of(
    "| room | holds | may include |\n| --- | --- | --- |\n"
    "| `a/low` | x | |\n| `a/high` | x, `not this` | `low` |\n| `b/top` | x | `a/high` |\n");

TEST(ArchitectureRules, ComeFromTheTable) {
  EXPECT_EQ(small_rules,
            (IncludeRules{{"a/low", {}}, {"a/high", {"a/low"}}, {"b/top", {"a/high"}}}));
}

TEST(ArchitectureRules, AreKeptByArrowsThatRunDown) {
  EXPECT_THAT(broken_rules(small_rules, {{"a/low/x.h", "#include <vector>\n"},
                                         {"a/high/y.h", "#include \"a/low/x.h\"\n"},
                                         {"a/high/y.cpp", "#include \"a/high/y.h\"\n"},
                                         {"b/top/z.cpp", "#include \"a/high/y.h\"\n"}}),
              IsEmpty());
}

TEST(ArchitectureRules, AreBrokenByAnArrowTurnedRound) {
  EXPECT_THAT(
      broken_rules(small_rules, {{"a/low/x.h", "\n#include \"a/high/y.h\"\n"}, {"a/high/y.h", ""}}),
      ElementsAre("a/low/x.h:2 includes a/high/y.h, but a/low may include only itself"));
}

TEST(ArchitectureRules, AreBrokenByARoomThatIsSkipped) {
  EXPECT_THAT(
      broken_rules(small_rules, {{"a/low/x.h", ""}, {"b/top/z.cpp", "#include \"a/low/x.h\"\n"}}),
      ElementsAre(HasSubstr("but b/top may include only a/high")));
}

TEST(ArchitectureRules, AreBrokenByWhatIsNotThere) {
  EXPECT_THAT(broken_rules(small_rules, {{"a/low/x.h", "#include \"a/low/gone.h\"\n"}}),
              ElementsAre(HasSubstr("a/low/gone.h, which does not exist")));
  EXPECT_THAT(broken_rules(small_rules, {{"c/new/x.h", ""}}),
              ElementsAre(HasSubstr("c/new, which the table of rooms does not list")));
}

TEST(ArchitectureRules, KeepLibrariesOutOfHeaders) {
  EXPECT_THAT(broken_rules(small_rules, {{"a/low/x.h", "#include <CGAL/Origin.h>\n"},
                                         {"a/low/x.cpp", "#include <CGAL/Origin.h>\n"}}),
              ElementsAre(HasSubstr("x.h:1 includes <CGAL/Origin.h>")));
  EXPECT_THAT(broken_rules(small_rules, {{"a/low/detail/x.h", "#include <CGAL/Origin.h>\n"},
                                         {"a/low/x.cpp", "#include \"a/low/detail/x.h\"\n"},
                                         {"a/high/y.cpp", "#include \"a/low/detail/x.h\"\n"}}),
              ElementsAre("a/high/y.cpp:1 includes a/low/detail/x.h, a detail of a/low"));
}

TEST(ArchitectureRules, AreNoneIfTheyRunInACircle) {
  const IncludeRules circle = {{"a/x", {"a/y"}}, {"a/y", {"a/x"}}};
  EXPECT_THAT(broken_rules(circle, {}), testing::Contains(HasSubstr("in a circle")));
  EXPECT_THAT(broken_rules({{"a/x", {"a/gone"}}}, {}), ElementsAre(HasSubstr("no row for it")));
}

}  // namespace
}  // namespace halfshade::test
