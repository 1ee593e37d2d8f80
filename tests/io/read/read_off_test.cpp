#include "io/read/read_scene.h"
#include "tests/support/scene_texts.h"

#include <gmock/gmock.h>
#include <string>

namespace halfshade {
namespace {

using test::expect_refused;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SceneFile read_off(const std::string& off) { return test::read_text("scene.off", off); }

const std::string off_vertices = "0.1 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 2 0\n";

TEST(ReadOff, KeepsPolygonsWhateverTheHeaderLooksLike) {
  for (const std::string header : {"OFF\n5 2 0\n", "OFF 5 2 0\n", "OFF\n5 2\n", "5 2 7\n",
                                   "OFF # text\n\n# counts\n5 2 0\n", "OFF\r\n5 2 0\r\n"}) {
    const SceneFile file = read_off(header + off_vertices + "5 0 1 2 4 3\n3 0 2 1\n");
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_EQ(file.scene.vertices.at(0), Vec3(0.1, 0, 0));
    ASSERT_EQ(file.scene.faces.size(), 2U);
    EXPECT_THAT(file.scene.faces[0].vertices, ElementsAre(0, 1, 2, 4, 3));
    EXPECT_THAT(file.scene.faces[1].vertices, ElementsAre(0, 2, 1));
  }
}

TEST(ReadOff, IgnoresColoursAndNormals) {
  const std::string faces = "3 0 1 2  255 0 0\n3 0 2 3 # left\n3 0 1 3 0.5 0.5 0.5 1\n";
  for (const std::string kind : {"COFF", "NOFF", "CNOFF", "STOFF", "STCNOFF"}) {
    const Scene scene =
        read_off(kind + "\n4 3 0\n0 0 0 1 0 0 1\n1 0 0 0 1 0 1\n1 1 0 0 0 1\n0 1 0\n" + faces)
            .scene;
    EXPECT_EQ(scene.vertices.size(), 4U);
    EXPECT_EQ(scene.vertices[2], Vec3(1, 1, 0));
    EXPECT_THAT(scene.faces.at(0).vertices, ElementsAre(0, 1, 2));
    EXPECT_THAT(scene.faces.at(2).vertices, ElementsAre(0, 1, 3));
  }
}

TEST(ReadOff, RemembersLines) {
  const Scene scene = read_off("OFF\n# c\n5 2 0\n" + off_vertices + "\n3 0 1 2\n3 0 2 1\n").scene;
  EXPECT_EQ(scene.faces[0].line, 10);
  EXPECT_EQ(scene.faces[1].line, 11);
}

TEST(ReadOff, WarnsOfWhatFollowsTheFaces) {
  EXPECT_THAT(read_off("OFF 5 1 0\n" + off_vertices + "3 0 1 2\n3 0 2 1\n").warnings,
              ElementsAre(HasSubstr("scene.off:8")));
}

struct BadOff {
  const char* name;
  std::string text;
  std::vector<std::string> sentence;
};

void PrintTo(const BadOff& file, std::ostream* out) { *out << file.name; }

class BadOffFile : public testing::TestWithParam<BadOff> {};

TEST_P(BadOffFile, IsRefusedWithFileAndLine) {
  expect_refused("scene.off", GetParam().text, GetParam().sentence);
}

const BadOff bad_off_files[] = {
    {"Empty", "", {"scene.off: the file is empty"}},
    {"CommentOnly", "# c\n", {"ends before its header"}},
    {"OtherKind", "4OFF\n", {"scene.off:1", "'4OFF'"}},
    {"Binary", "OFF BINARY\n", {"binary"}},
    {"CountsMissing", "OFF\n", {"numbers of vertices and faces"}},
    {"OneCount", "OFF\n5\n", {"scene.off:2"}},
    {"CountNegative", "OFF\n5 -2 0\n", {"scene.off:2", "'-2'"}},
    {"VertexCountHuge", "OFF\n999999999999 1 0\n", {"scene.off:2", "999999999999"}},
    {"FaceCountHuge", "OFF\n0 999999999999 0\n", {"scene.off:2", "999999999999"}},
    {"VertexShort",
     "OFF\n5 2 0\n0 0\n" + off_vertices,
     {"scene.off:3", "vertex 0", "2 coordinates"}},
    {"VertexWord", "OFF\n5 2 0\n0 0 o\n" + off_vertices, {"scene.off:3", "'o'"}},
    {"VertexNan", "OFF\n5 2 0\n0 0 nan\n" + off_vertices, {"scene.off:3", "'nan'"}},
    {"VerticesMissing", "OFF\n5 2 0\n0 0 0\n1 1 1\n#######\n#######\n#", {"before vertex 2"}},
    {"FacesMissing", "OFF\n5 2 0\n" + off_vertices + "3 0 1 2\n", {"before face 2"}},
    {"FaceShort",
     "OFF\n5 1 0\n" + off_vertices + "4 0 1 2\n",
     {"scene.off:8", "face 1", "4 corners"}},
    {"FaceCountWord", "OFF\n5 1 0\n" + off_vertices + "x 0 1 2\n", {"scene.off:8", "'x'"}},
    {"FaceCountNegative", "OFF\n5 1 0\n" + off_vertices + "-1 0 1 2\n", {"scene.off:8", "'-1'"}},
    {"FaceIndexWord", "OFF\n5 1 0\n" + off_vertices + "3 0 1 b\n", {"scene.off:8", "'b'"}},
    {"TwoCorners", "OFF\n5 1 0\n" + off_vertices + "2 0 1\n", {"face 1 (line 8)", "2 vertices"}},
    {"IndexTooLarge", "OFF\n5 1 0\n" + off_vertices + "3 0 1 5\n", {"face 1 (line 8)", "vertex 5"}},
    {"IndexNegative",
     "OFF\n5 1 0\n" + off_vertices + "3 0 1 -1\n",
     {"face 1 (line 8)", "vertex -1"}},
    {"NoFaces", "OFF\n5 0 0\n" + off_vertices, {"no faces"}},
};

INSTANTIATE_TEST_SUITE_P(Files, BadOffFile, testing::ValuesIn(bad_off_files),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace halfshade
