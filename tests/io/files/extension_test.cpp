#include "io/files/extension.h"

#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

constexpr FileFormats one = {"maps", {".png"}}, two = {"tables", {".csv", ".vtp"}},
                      four = {"things", {".a", ".b", ".c", ".d"}};

TEST(Extension, IsInSmallLetters) {
  EXPECT_EQ(extension_of("a/B.VtU"), ".vtu");
  EXPECT_EQ(extension_of("a.b/c"), "");
}

TEST(Extension, TellsFormats) {
  EXPECT_TRUE(has_format("x.png", one));
  EXPECT_TRUE(has_format("x.VTP", two));
  EXPECT_TRUE(has_format("x.d", four));
  EXPECT_FALSE(has_format("x.csv", one));
  EXPECT_FALSE(has_format("x", one)) << "no extension is none of them";
  EXPECT_FALSE(has_format("", two));
}

TEST(Extension, SaysWhatIsWritten) {
  const auto refuse = [](const FileFormats& formats, const char* sentence) {
    test::expect_error([&] { require_format("x.doc", formats); }, ErrorCode::usage,
                       {"x.doc", sentence, "not as '.doc'"});
  };
  refuse(one, "maps are written as .png,");
  refuse(two, "tables are written as .csv or .vtp,");
  refuse(four, "things are written as .a, .b, .c or .d,");
  EXPECT_NO_THROW(require_format("x.csv", two));
}

}  // namespace
}  // namespace halfshade
