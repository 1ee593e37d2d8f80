#include "io/files/little_endian.h"
#include "io/read/read_scene.h"
#include "tests/support/files.h"

#include <cstdint>
#include <gmock/gmock.h>

namespace halfshade {
namespace {

using test::expect_error;
using test::TempDir;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string ascii_stl =
    "solid box\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\n"
    "endloop\nendfacet\nendsolid box\n";

std::string binary_stl() {
  std::string bytes(80, ' ');
  detail::put(bytes, std::uint32_t{1});
  for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.5F})
    detail::put(bytes, x);
  detail::put(bytes, std::uint16_t{0});
  return bytes;
}

TEST(ReadStl, ReadsTextAndBinary) {
  const TempDir folder;
  for (const auto& path : {folder.write("a.stl", ascii_stl), folder.write("b.stl", binary_stl())}) {
    const Scene scene = read_scene(path).scene;
    ASSERT_EQ(scene.faces.size(), 1U);
    EXPECT_THAT(face_corners(scene, 0), ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.5)));
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].name, "default");
    EXPECT_TRUE((scene.materials[0].rho == Material{}.rho).all());
    EXPECT_TRUE((scene.materials[0].exitance == 0).all());
  }
}

TEST(ReadStl, NamesGroups) {
  const TempDir folder;
  EXPECT_THAT(read_scene(folder.write("a.stl", ascii_stl)).scene.groups, ElementsAre("box"));
  EXPECT_THAT(read_scene(folder.write("b.stl", binary_stl())).scene.groups, ElementsAre("default"));
}

TEST(ReadStl, RefusesTruncatedFilesAndNan) {
  const TempDir folder;
  for (const std::size_t size : {20U, 84U, 100U})
    expect_error([&] { read_scene(folder.write("b.stl", binary_stl().substr(0, size))); },
                 ErrorCode::invalid_input, {"b.stl"});
  std::string bytes = binary_stl();
  bytes.replace(84 + 12, 4, std::string("\0\0\xC0\x7F", 4));  // a quiet NaN
  expect_error([&] { read_scene(folder.write("b.stl", bytes)); }, ErrorCode::invalid_input,
               {"b.stl", "vertex 1", "nan"});
}

TEST(ReadStl, NamesMayHaveSpacesAndKeywordsCapitals) {
  std::string text = ascii_stl;
  text.replace(0, 9, "SOLID  the long  table ");
  for (const char* word : {"facet", "outer", "vertex", "endloop", "endfacet", "endsolid"}) {
    const std::size_t at = text.find(word);
    text[at] = static_cast<char>(text[at] - 'a' + 'A');
  }
  const TempDir folder;
  const SceneFile file = read_scene(folder.write("a.stl", text + ascii_stl + "solid\nendsolid\n"));
  EXPECT_THAT(file.scene.groups, ElementsAre("the long  table", "box"));
  EXPECT_EQ(file.scene.faces.size(), 2U);
  EXPECT_EQ(file.scene.faces[1].line, 11);
  EXPECT_THAT(file.warnings, IsEmpty());
}

TEST(ReadStl, KeepsAllDigitsOfTexts) {
  std::string text = ascii_stl;
  text.replace(text.find("vertex 1"), 8, "vertex 0.1234567890123456");
  const TempDir folder;
  EXPECT_EQ(read_scene(folder.write("a.stl", text)).scene.vertices[1].x(), 0.1234567890123456);
}

TEST(ReadStl, ABinaryFileMayBeginLikeAText) {
  std::string bytes = binary_stl();
  bytes.replace(0, 9, "solid box");
  const TempDir folder;
  EXPECT_EQ(read_scene(folder.write("b.stl", bytes)).scene.faces.size(), 1U);
  const SceneFile longer = read_scene(folder.write("c.stl", binary_stl() + "more"));
  EXPECT_THAT(longer.warnings, ElementsAre(HasSubstr("not used")));
}

TEST(ReadStl, NamesTheLineOfAMistake) {
  const auto expect_refused = [](const std::string& from, const std::string& to,
                                 const std::string& place) {
    std::string text = ascii_stl;
    text.replace(text.find(from), from.size(), to);
    const TempDir folder;
    expect_error([&] { read_scene(folder.write("a.stl", text)); }, ErrorCode::invalid_input,
                 {place});
  };
  expect_refused("vertex 1 0 0", "vertex 1 0", "a.stl:5");
  expect_refused("vertex 1 0 0", "vertex 1 inf 0", "a.stl:5");
  expect_refused("vertex 1 0 0", "vertices", "a.stl:5");
  expect_refused("vertex 1 0 0\n", "", "a.stl:6");
  expect_refused("endsolid box\n", "", "a.stl: the file ends within solid 'box'");
  expect_refused("endsolid", "solid", "a.stl:9");
}

}  // namespace
}  // namespace halfshade
