#include "io/read/read_scene.h"
#include "tests/support/files.h"

#include <clocale>
#include <gmock/gmock.h>
#include <string>
#include <utility>

namespace halfshade {
namespace {

using test::expect_error;
using test::TempDir;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

SceneFile read_obj(const std::string& obj, const std::string& mtl = "") {
  const TempDir folder;
  if (!mtl.empty()) folder.write("scene.mtl", mtl);
  return read_scene(folder.write("scene.obj", obj));
}

/// What a material of a file with a square of material "m" becomes.
SceneFile read_material(const std::string& lines) {
  return read_obj("mtllib scene.mtl\nusemtl m\n" + square + "f 1 2 3 4\n", "newmtl m\n" + lines);
}

TEST(ReadObj, TakesCapitalKeywordsAndSaysWhatItRead) {
  const SceneFile file =
      read_obj("MTLLIB scene.mtl\nO box\nUSEMTL m\nV 0 0 0\nV 1 0 0\nV 1 1 0\nVN 0 0 1\nF 1 2 3\n",
               "NEWMTL m\nKD 0.25 0.25 0.25\nKE 1 2 3\n");
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_THAT(file.scene.groups, ElementsAre("box"));
  EXPECT_EQ(file.scene.materials.at(0).rho[1], 0.25);
  EXPECT_EQ(file.scene.materials.at(0).exitance[2], 3);
  ASSERT_EQ(file.files.size(), 1U);
  EXPECT_EQ(file.files[0].filename(), "scene.mtl");
}

TEST(ReadObj, KeepsPolygonsTheirOrderAndTheirLines) {
  const Scene scene =
      read_obj("# a comment\n" + square + "\nv 0.5 2 0\nf 1 2 3 5 4\nf 4 3 2\n").scene;
  ASSERT_EQ(scene.vertices.size(), 5U);
  EXPECT_EQ(scene.vertices[4], Vec3(0.5, 2, 0));
  ASSERT_EQ(scene.faces.size(), 2U);
  EXPECT_THAT(scene.faces[0].vertices, ElementsAre(0, 1, 2, 4, 3));
  EXPECT_THAT(scene.faces[1].vertices, ElementsAre(3, 2, 1));
  EXPECT_EQ(scene.faces[0].line, 8);
  EXPECT_EQ(scene.faces[1].line, 9);
}

TEST(ReadObj, TakesEdgesForFacesWithoutArea) {
  const Scene scene = read_obj(square + "f 1 2\nf 1 2 3 4\n").scene;
  ASSERT_EQ(scene.faces.size(), 2u);
  EXPECT_EQ(scene.faces[0].vertices, (std::vector<int>{0, 1, 0}));
  EXPECT_NO_THROW(validate(scene));
}

TEST(ReadObj, RoundsCoordinatesToTheNearestDouble) {
  const Scene scene =
      read_obj(
          "v 0.1 -1e-3 +2.5E2\nv 0.30000000000000004 1e-400 .5\nv 1. -0 123456789.123456789\n"
          "f 1 2 3\n")
          .scene;
  EXPECT_EQ(scene.vertices[0], Vec3(0.1, -1e-3, 250));
  EXPECT_EQ(scene.vertices[1], Vec3(0.1 + 0.2, 0, 0.5));
  EXPECT_EQ(scene.vertices[2], Vec3(1, 0, 123456789.123456789));
}

TEST(ReadObj, DoesNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  const Scene scene = read_obj("v 0.25 0 0\nv 1.5 0 0\nv 0 1 0\nf 1 2 3\n").scene;
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(scene.vertices[0].x(), 0.25);
  EXPECT_EQ(scene.vertices[1].x(), 1.5);
}

TEST(ReadObj, ResolvesRelativeAndForwardAndTexturedIndices) {
  const Scene scene =
      read_obj(
          "f 1//7 2/3/7 4/5\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2/1 -1//1\nv 0 1 0\nf -4 -1 -2\n")
          .scene;
  EXPECT_THAT(scene.faces[0].vertices, ElementsAre(0, 1, 3));
  EXPECT_THAT(scene.faces[1].vertices, ElementsAre(0, 1, 2));
  EXPECT_THAT(scene.faces[2].vertices, ElementsAre(0, 3, 2));
}

TEST(ReadObj, GroupsFacesUnderTheMostRecentName) {
  const Scene scene =
      read_obj(square +
               "f 1 2 3\no Room\ng floor\nf 1 2 4\ng\nf 2 3 4\no Two words\nf 1 3 4\n"
               "g floor\nf 4 3 1\n")
          .scene;
  EXPECT_THAT(scene.groups, ElementsAre("default", "floor", "Two words"));
  std::vector<int> groups;
  for (const Face& face : scene.faces) groups.push_back(face.group);
  EXPECT_THAT(groups, ElementsAre(0, 1, 0, 2, 1));
}

TEST(ReadObj, ReadsTheSameUnderAnyLineEnding) {
  const std::string text =
      "mtllib scene.mtl\ng a\\\nb\nusemtl m # the\nv 0 0 0\nv 1 0 0 # right\nv 1 \\\n1 0\nf 1 2 "
      "3\n";
  const std::string mtl = "newmtl m\nKd .1 .2 .3\n";
  const auto with_endings = [](std::string s, const std::string& ending) {
    for (std::size_t at = 0; (at = s.find('\n', at)) != s.npos; at += ending.size())
      s.replace(at, 1, ending);
    return s;
  };
  for (const std::string ending : {"\n", "\r\n", "\r"}) {
    const SceneFile file = read_obj(with_endings(text, ending), with_endings(mtl, ending));
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_EQ(file.scene.vertices[2], Vec3(1, 1, 0));
    EXPECT_EQ(file.scene.faces[0].line, 9);
    EXPECT_THAT(file.scene.groups, ElementsAre("a b"));
    EXPECT_EQ(file.scene.materials[0].name, "m");
    EXPECT_TRUE((file.scene.materials[0].rho == Rgb(.1, .2, .3)).all());
  }
}

TEST(ReadObj, SkipsAByteOrderMarkAndDoesNotContinueComments) {
  const Scene scene =
      read_obj("\xEF\xBB\xBFv 0 0 0\n# C:\\models\\\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").scene;
  EXPECT_EQ(scene.vertices.size(), 3U);
}

TEST(ReadObj, WarnsOfEachUnusedStatementOnce) {
  const SceneFile file =
      read_obj(square + "vt 0 0\nvn 0 0 1\ns off\nl 1 2\np 1\ncurv 1\ncurv 2\nbevel on\nf 1 2 3\n");
  ASSERT_EQ(file.warnings.size(), 2U);
  EXPECT_THAT(file.warnings[0], HasSubstr("scene.obj:10: statements that begin with 'curv'"));
  EXPECT_THAT(file.warnings[1], HasSubstr("'bevel'"));
}

TEST(ReadObj, WarnsIfTheLastLineMayBeCut) {
  EXPECT_THAT(read_obj(square + "f 1 2 3").warnings, ElementsAre(HasSubstr("scene.obj:5")));
}

TEST(ReadMtl, TakesKdAsReflectanceAndKeAsExitance) {
  const SceneFile file = read_material("Ka 1 1 1\nKd 0.1 0.25 1\nKe 15 0 3e3\nillum 2\nd 1\n");
  const Material& m = file.scene.materials.at(0);
  EXPECT_EQ(m.name, "m");
  EXPECT_TRUE((m.rho == Rgb(0.1, 0.25, 1)).all());
  EXPECT_TRUE((m.exitance == Rgb(15, 0, 3000)).all());
  EXPECT_FALSE(m.two_sided);
  EXPECT_THAT(file.warnings, IsEmpty());
}

TEST(ReadMtl, SpreadsASingleNumberOverTheChannels) {
  EXPECT_TRUE((read_material("Kd 0.3\n").scene.materials[0].rho == 0.3).all());
}

TEST(ReadMtl, WarnsOfWhatIsNotUsed) {
  EXPECT_THAT(read_material("Kd 1 1 1\nmap_Kd wood.png\n").warnings,
              ElementsAre(HasSubstr("scene.mtl:3: there is no picture 'wood.png'")));
  EXPECT_THAT(read_material("Kd 1 1 1\nmap_Kd -s 2 2 1 wood.png\nmap_Kd oak.png\n").warnings,
              ElementsAre(HasSubstr("'wood.png'"), HasSubstr("'oak.png'")));
  EXPECT_THAT(read_material("Kd 1 1 1\nd 0.5\n").warnings, ElementsAre(HasSubstr("opaque")));
  EXPECT_THAT(read_material("Kd 1 1 1\nTr 0.5\n").warnings, ElementsAre(HasSubstr("opaque")));
  EXPECT_THAT(read_material("Kd 1 1 1\nTr 0\nTr 0\n").warnings, IsEmpty());
  EXPECT_THAT(read_material("Kd 1 1 1\nglow 1\nglow 2\n").warnings,
              ElementsAre(HasSubstr("'glow'")));
  EXPECT_THAT(read_material("Ke 1 1 1\n").warnings, ElementsAre(HasSubstr("no Kd")));
  EXPECT_THAT(read_material("Kd 1 1 1\nnewmtl m\nKd 0 0 0\n").warnings,
              ElementsAre(HasSubstr("defined again")));
}

TEST(ReadMtl, WarnsOfWhatIsSaidTwiceInAMaterial) {
  EXPECT_THAT(read_material("Kd 1 1 1\nKd .5 .5 .5\n").warnings,
              ElementsAre(AllOf(HasSubstr("scene.mtl:3"), HasSubstr("'m' has another Kd"))));
  EXPECT_THAT(read_material("emissivity .5\nemissivity .7\ntemperature 300\n").warnings,
              ElementsAre(HasSubstr("another emissivity")));
  EXPECT_THAT(read_material("Kd 1\ntemperature 300\ntemperature 400\n").warnings,
              ElementsAre(HasSubstr("another temperature")));
  EXPECT_THAT(read_material("Kd .5\nKd 0.50 .5 .5\nKe 0 0 0\nKe 0\n").warnings, IsEmpty());
  EXPECT_THAT(read_material("Kd .5\nnewmtl n\nKd .6\n").warnings, IsEmpty());
}

TEST(ReadMtl, IsFoundUnderNamesWithSpacesAndInOtherFolders) {
  const TempDir folder;
  folder.write("sub dir/a b.mtl", "newmtl red wall\nKd 1 0 0\n");
  folder.write("c.mtl", "newmtl blue\nKd 0 0 1\n");
  for (const std::string library : {"mtllib sub dir/a b.mtl\nmtllib c.mtl\n",
                                    "mtllib sub dir\\a b.mtl\nmtllib c.mtl c.mtl\n"}) {
    const SceneFile file = read_scene(folder.write(
        "my scene.obj", library + square + "usemtl red wall\nf 1 2 3\nusemtl blue\nf 1 3 4\n"));
    ASSERT_EQ(file.scene.materials.size(), 2U);
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_TRUE((file.scene.materials[0].rho == Rgb(1, 0, 0)).all());
    EXPECT_TRUE((file.scene.materials[1].rho == Rgb(0, 0, 1)).all());
    EXPECT_EQ(file.scene.faces[1].material, 1);
  }
}

TEST(ReadMtl, MayComeAfterItsUse) {
  const Scene scene =
      read_obj(square + "usemtl m\nf 1 2 3\nmtllib scene.mtl\n", "newmtl m\nKd 0 1 0\n").scene;
  EXPECT_TRUE((scene.materials.at(0).rho == Rgb(0, 1, 0)).all());
}

TEST(ReadMtl, LeavesOutMaterialsThatNoFaceUses) {
  const Scene scene = read_obj("mtllib scene.mtl\nusemtl b\n" + square + "f 1 2 3\n",
                               "newmtl a\nKd 7 7 7\nnewmtl b\nKd 1 1 1\nnewmtl c\nKd 0 0 0\n")
                          .scene;
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].name, "b");
  EXPECT_EQ(scene.faces[0].material, 0);
}

TEST(ReadObj, GivesFacesWithoutMaterialTheDefaultOne) {
  const Scene scene = read_obj(square + "f 1 2 3\n").scene;
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].name, "default");
  EXPECT_TRUE((scene.materials[0].exitance == 0).all());
}

struct BadObj {
  const char* name;
  std::string obj;
  std::vector<std::string> sentence;
  std::string mtl = "";
};

void PrintTo(const BadObj& file, std::ostream* out) { *out << file.name; }

class BadObjFile : public testing::TestWithParam<BadObj> {};

TEST_P(BadObjFile, IsRefusedWithFileAndLine) {
  const TempDir folder;
  folder.write("m.mtl", GetParam().mtl);
  const auto path = folder.write("scene.obj", GetParam().obj);
  expect_error([&] { read_scene(path); }, ErrorCode::invalid_input, GetParam().sentence);
}

std::string with_m(const std::string& usemtl = "m") {
  return "mtllib m.mtl\nusemtl " + usemtl + "\n" + square + "f 1 2 3\n";
}

const BadObj bad_obj_files[] = {
    {"Empty", "", {"scene.obj: the file is empty"}},
    {"CommentOnly", "# nothing\n", {"scene.obj", "no faces"}},
    {"VerticesOnly", square, {"scene.obj", "no faces"}},
    {"Utf16", {"\xFF\xFEv\0", 4}, {"UTF-16"}},
    {"CutVertex", "v 0 0 0\nv 1 0", {"scene.obj:2: vertex 2 has 2 coordinates"}},
    {"CutFace", square + "f 1 2", {"scene.obj:5: face 1 has 2 vertices"}},
    {"FaceWithoutVertices", square + "f\n", {"scene.obj:5", "0 vertices"}},
    {"Nan", "v 0 nan 0\n", {"scene.obj:1", "'nan'", "finite"}},
    {"Infinite", "v 0 0 0\nv 0 0 -inf\n", {"scene.obj:2", "'-inf'"}},
    {"Overflow", "v 1e999 0 0\n", {"scene.obj:1", "'1e999'"}},
    {"Word", "v 0 zero 0\n", {"scene.obj:1", "'zero' is not a number"}},
    {"TwoSigns", "v +-1 0 0\n", {"'+-1' is not a number"}},
    {"Comma", "v 0,5 0 0\n", {"'0,5' is not a number", "point"}},
    {"Zero", square + "\nf 0 1 2\n", {"scene.obj:6: face 1 names vertex 0", "from 1"}},
    {"TooLarge", square + "f 1 2 9\n", {"scene.obj:5: face 1 names vertex 9", "4 vertices"}},
    {"TooNegative", square + "f 1 2 -5\n", {"scene.obj:5: face 1 names vertex -5"}},
    {"Huge", square + "f 1 2 99999999999\n", {"scene.obj:5", "99999999999"}},
    {"BeyondIntegers", square + "f 1 2 99999999999999999999\n", {"scene.obj:5", "not an index"}},
    {"IndexWord", square + "f 1 2 x\n", {"scene.obj:5: 'x' in face 1"}},
    {"IndexReal", square + "f 1 2 3.5\n", {"scene.obj:5", "'3.5'"}},
    {"IndexTail", square + "f 1 2 3/a\n", {"scene.obj:5", "'3/a'"}},
    {"LibraryMissingWithALongName", "mtllib " + std::string(1200, 'm') + "\n", {"…mmm", "no file"}},
    {"LibraryMissing", "mtllib none.mtl\n", {"scene.obj:1", "'none.mtl'", "no file"}},
    {"LibraryUnnamed", "mtllib\n", {"scene.obj:1"}},
    {"LibraryIsFolder", "mtllib .\n", {"directory"}},
    {"LibraryWithALongName", "mtllib " + std::string(1300, '/') + "\n", {"…///", "directory"}},
    {"LibraryEmpty", with_m(), {"m.mtl: the file is empty"}},
    {"MaterialUnnamed", "usemtl\n", {"scene.obj:1"}},
    {"MaterialUnknown", with_m("other"), {"scene.obj:2", "'other'"}, "newmtl m\nKd 0 0 0\n"},
    {"MaterialWithoutLibrary", "usemtl x\n" + square + "f 1 2 3\n", {"scene.obj:1", "'x'"}},
    {"KdAboveOne",
     with_m(),
     {"m.mtl:3", "'m'", "1.2", "channel 2"},
     "newmtl m\nKe 1 1 1\nKd 0 1.2 0\n"},
    {"KdNan", with_m(), {"m.mtl:2", "nan"}, "newmtl m\nKd nan 0 0\n"},
    {"KeNegative", with_m(), {"m.mtl:3", "-3", "channel 3"}, "newmtl m\nKd 0 0 0\nKe 1 1 -3\n"},
    {"KeInfinite", with_m(), {"m.mtl:2", "inf"}, "newmtl m\nKe inf 0 0\n"},
    {"KdTwoNumbers", with_m(), {"m.mtl:2", "2 numbers"}, "newmtl m\nKd 0 0\n"},
    {"KdWord", with_m(), {"m.mtl:2", "'red'"}, "newmtl m\nKd red\n"},
    {"KdSpectral", with_m(), {"m.mtl:2", "spectral"}, "newmtl m\nKd spectral a.rfl\n"},
    {"KdTooEarly", with_m(), {"m.mtl:1", "before any newmtl"}, "Kd 0 0 0\n"},
    {"NewmtlUnnamed", with_m(), {"m.mtl:1"}, "newmtl\n"},
};

INSTANTIATE_TEST_SUITE_P(Files, BadObjFile, testing::ValuesIn(bad_obj_files),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace halfshade
