#include "io/read/read_scene.h"
#include "tests/support/scene_texts.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <gmock/gmock.h>
#include <string>

namespace halfshade {
namespace {

using test::TempDir;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SceneFile read_ply(const std::string& ply) { return test::read_text("scene.ply", ply); }

void expect_refused(const std::string& ply, const std::vector<std::string>& parts) {
  test::expect_refused("scene.ply", ply, parts);
}

const std::string ascii_header =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty double x\n"
    "property double y\nproperty double z\nproperty uchar red\nelement face 2\n"
    "property uchar flags\nproperty list uchar int vertex_indices\nend_header\n";
const std::string ascii_data =
    "0.1 0 0 255\n1 0 0 0\n1 1 0 0\n0 1 0 7\n0.5 2e0 0 1\n\n0 5 0 1 2 4 3\n1 3 0 2 1\n";

/// The bytes of a value, first the lowest or the highest.
template <typename T>
std::string bytes_of(T value, bool big_endian) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big_endian == (std::endian::native == std::endian::little))
    std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// A square of mixed types with lists to skip, and a triangle on it.
std::string binary_file(bool big_endian, const std::string& ending = "\n") {
  std::string text = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                     "_endian 1.0\nelement vertex 4\nproperty float32 y\nproperty list uint8 "
                     "int16 weights\nproperty double x\nproperty short z\nelement edge 1\n"
                     "property int a\nelement face 2\nproperty list uint uint16 vertex_index\n"
                     "property float area\nend_header\n";
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += ending.size())
    text.replace(at, 1, ending);
  const auto add = [&](auto value) { text += bytes_of(value, big_endian); };
  for (int i = 0; i < 4; ++i) {
    add(i < 2 ? 0.0F : 1.0F);
    add(std::uint8_t{2});
    add(std::int16_t{10});
    add(std::int16_t{13});
    add(i == 0 || i == 3 ? 0.1 : 1.0);
    add(std::int16_t{-2});
  }
  add(std::int32_t{0});
  for (const std::vector<std::uint16_t>& face :
       {std::vector<std::uint16_t>{0, 1, 2, 3}, std::vector<std::uint16_t>{0, 2, 1}}) {
    add(static_cast<std::uint32_t>(face.size()));
    for (const std::uint16_t v : face) add(v);
    add(0.5F);
  }
  return text;
}

TEST(ReadPly, ReadsTextWithPolygonsAndLines) {
  const SceneFile file = read_ply(ascii_header + ascii_data);
  EXPECT_THAT(file.warnings, IsEmpty());
  ASSERT_EQ(file.scene.vertices.size(), 5U);
  EXPECT_EQ(file.scene.vertices[0], Vec3(0.1, 0, 0));
  EXPECT_EQ(file.scene.vertices[4], Vec3(0.5, 2, 0));
  ASSERT_EQ(file.scene.faces.size(), 2U);
  EXPECT_THAT(file.scene.faces[0].vertices, ElementsAre(0, 1, 2, 4, 3));
  EXPECT_THAT(file.scene.faces[1].vertices, ElementsAre(0, 2, 1));
  EXPECT_EQ(file.scene.faces[0].line, 19);
  EXPECT_EQ(file.scene.faces[1].line, 20);
  EXPECT_THAT(file.scene.groups, ElementsAre("default"));
  EXPECT_EQ(file.scene.materials.at(0).name, "default");
}

TEST(ReadPly, ReadsTextUnderAnyLineEnding) {
  for (const std::string ending : {"\r\n", "\r"}) {
    std::string text = ascii_header + ascii_data;
    for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += ending.size())
      text.replace(at, 1, ending);
    const Scene scene = read_ply(text).scene;
    EXPECT_EQ(scene.vertices[4], Vec3(0.5, 2, 0));
    EXPECT_EQ(scene.faces[1].line, 20);
  }
}

TEST(ReadPly, ReadsBothByteOrdersAndAllLineEndings) {
  for (const bool big_endian : {false, true})
    for (const std::string ending : {"\n", "\r\n", "\r"}) {
      const SceneFile file = read_ply(binary_file(big_endian, ending));
      EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("'edge' are not used")));
      ASSERT_EQ(file.scene.vertices.size(), 4U);
      EXPECT_EQ(file.scene.vertices[0], Vec3(0.1, 0, -2));
      EXPECT_EQ(file.scene.vertices[2], Vec3(1, 1, -2));
      ASSERT_EQ(file.scene.faces.size(), 2U);
      EXPECT_THAT(file.scene.faces[0].vertices, ElementsAre(0, 1, 2, 3));
      EXPECT_THAT(file.scene.faces[1].vertices, ElementsAre(0, 2, 1));
      EXPECT_EQ(file.scene.faces[0].line, 0);
    }
}

TEST(ReadPly, RefusesEveryTruncation) {
  const TempDir folder;
  for (const std::string& whole :
       {binary_file(false), binary_file(true), ascii_header + ascii_data})
    for (std::size_t size = 0; size + 2 < whole.size(); ++size)
      EXPECT_THROW(read_scene(folder.write("scene.ply", whole.substr(0, size))), Error)
          << size << " of " << whole.size();
}

TEST(ReadPly, WarnsOfWhatFollowsTheFaces) {
  EXPECT_THAT(read_ply(ascii_header + ascii_data + "1 2 3\n").warnings,
              ElementsAre(HasSubstr("last element")));
}

/// `text` with the first `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ReadPly, DoesNotBelieveCountsThatCannotBe) {
  const std::string whole = ascii_header + ascii_data;
  for (const char* count : {"999999999999", "9223372036854775807", "1000"}) {
    expect_refused(replaced(whole, "vertex 5", std::string("vertex ") + count),
                   {"scene.ply", count, "'vertex'", "cut short"});
    expect_refused(replaced(whole, "face 2", std::string("face ") + count),
                   {"scene.ply", count, "'face'"});
  }
  expect_refused(replaced(whole, "\n0 5 0 1", "\n0 4000000000 0 1"),
                 {"scene.ply:19", "4000000000", "'vertex_indices'"});
  // A file of 2^32 − 1 corners in its last list.
  std::string binary = binary_file(false);
  binary.replace(binary.size() - 14, 4, "\xFF\xFF\xFF\xFF");
  expect_refused(binary, {"4294967295"});
}

struct BadPly {
  const char* name;
  std::string from, to;
  std::vector<std::string> sentence;
};

void PrintTo(const BadPly& file, std::ostream* out) { *out << file.name; }

class BadPlyFile : public testing::TestWithParam<BadPly> {};

TEST_P(BadPlyFile, IsRefusedWithFileAndLine) {
  const std::string text = replaced(ascii_header + ascii_data, GetParam().from, GetParam().to);
  expect_refused(text, GetParam().sentence);
}

const BadPly bad_ply_files[] = {
    {"NotPly", "ply", "plx", {"scene.ply:1", "'ply'"}},
    {"FormatUnknown", "ascii", "utf8", {"scene.ply:2", "'utf8'"}},
    {"FormatMissing", "format ascii 1.0\n", "", {"format"}},
    {"KeywordUnknown", "comment", "kommentar", {"scene.ply:3", "'kommentar'"}},
    {"CountNegative", "vertex 5", "vertex -5", {"scene.ply:4"}},
    {"CountWord", "vertex 5", "vertex five", {"scene.ply:4", "five"}},
    {"TypeUnknown", "double x", "quad x", {"scene.ply:5", "'quad'"}},
    {"ListOfReals", "list uchar int", "list float int", {"scene.ply:11"}},
    {"RealIndices", "list uchar int", "list uchar float", {"vertex_indices"}},
    {"NoCoordinate", "double z", "double w", {"property z"}},
    {"TwoCoordinates", "uchar red", "uchar x", {"property x"}},
    {"NoIndices", "vertex_indices", "corners", {"'vertex_indices'"}},
    {"PropertyFirst", "element vertex 5\n", "", {"scene.ply:4", "before any element"}},
    {"FacesFirst", "element vertex 5", "element face 0\nelement vertex 5", {"before the vertices"}},
    {"HeaderOnly", "end_header", "end", {"scene.ply:12"}},
    {"Nan", "2e0", "nan", {"scene.ply:17", "vertex 4", "nan"}},
    {"Word", "2e0", "two", {"scene.ply:17", "'two'"}},
    {"IndexTooLarge", "4 3\n", "4 5\n", {"face 1 (line 19)", "vertex 5", "0 to 4"}},
    {"IndexNegative", "4 3\n", "4 -1\n", {"face 1 (line 19)", "vertex -1"}},
    {"IndexReal", "4 3\n", "4 3.5\n", {"scene.ply:19", "'3.5'"}},
    {"TwoCorners", "1 3 0 2 1\n", "1 2 0 2\n", {"face 2 (line 20)", "2 vertices"}},
    {"ListNegative", "1 3 0 2 1\n", "1 -3 0 2 1\n", {"scene.ply:20", "-3"}},
    {"NoFaces", "face 2", "face 0", {"no faces"}},
};

INSTANTIATE_TEST_SUITE_P(Files, BadPlyFile, testing::ValuesIn(bad_ply_files),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace halfshade
