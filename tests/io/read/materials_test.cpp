#include "io/read/read_scene.h"
#include "tests/support/files.h"

#include <gmock/gmock.h>
#include <string>

namespace halfshade {
namespace {

using test::expect_error;
using test::TempDir;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Three faces: red and white ones in the group "room", a red one in the group "lamp".
const std::string two_squares =
    "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "g room\nusemtl red\nf 1 2 3\nusemtl white\nf 1 3 4\ng lamp\nusemtl red\nf 1 2 4\n";
const std::string two_materials =
    "newmtl red\nKd 0.6 0.1 0.1\nnewmtl white\nKd 0.8 0.8 0.8\nKe 1 2 3\n";

SceneFile read_with(const std::string& materials, const std::string& sidecar = "",
                    const std::string& scene = two_squares) {
  const TempDir folder;
  folder.write("scene.mtl", two_materials);
  if (!sidecar.empty()) folder.write("scene.json", sidecar);
  const auto path = folder.write("scene.obj", scene);
  return materials.empty() ? read_scene(path)
                           : read_scene(path, folder.write("extra.json", materials));
}

const Material& material_of(const Scene& scene, std::size_t face) {
  return scene.materials.at(static_cast<std::size_t>(scene.faces.at(face).material));
}

TEST(Materials, OverrideAMaterialWhereverItIsUsed) {
  const Scene scene = read_with(R"({"red": {"reflectance": [0.5, 0.25, 0]}})").scene;
  ASSERT_EQ(scene.materials.size(), 2U);
  for (const std::size_t face : {0U, 2U})
    EXPECT_TRUE((material_of(scene, face).rho == Rgb(0.5, 0.25, 0)).all());
  EXPECT_TRUE((material_of(scene, 1).rho == 0.8).all());
}

TEST(Materials, ALibraryThatIsNotThereDoesNotMatterIfAllIsGiven) {
  std::string scene = two_squares;
  scene.replace(scene.find("scene.mtl"), 9, "other.mtl");
  const std::string both = R"({"red": {"reflectance": 0.5}, "white": {"exitance": 1}})";
  EXPECT_THAT(read_with(both, "", scene).warnings,
              ElementsAre(HasSubstr("scene.obj:1: mtllib names")));
  EXPECT_THAT(read_with("", R"({"materials": )" + both + "}", scene).warnings,
              ElementsAre(HasSubstr("'other.mtl'")));
  expect_error([&] { read_with(R"({"red": {"reflectance": 0.5}})", "", scene); },
               ErrorCode::invalid_input, {"scene.obj:1", "'other.mtl'"});
  expect_error([&] { read_with("", "", scene); }, ErrorCode::invalid_input, {"'other.mtl'"});
}

TEST(Materials, OneNameForTwoThingsIsTold) {
  std::string scene = two_squares;
  scene.replace(scene.find("g lamp"), 6, "g red");  // a group of one of the two red faces
  EXPECT_THAT(read_with(R"({"red": {"reflectance": 0.5}})", "", scene).warnings,
              ElementsAre(HasSubstr("'red' names a group and a material")));
  EXPECT_THAT(read_with(R"({"white": {"reflectance": 0.5}})", "", scene).warnings, IsEmpty());
  const std::string same =
      "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\ng red\nusemtl red\nf 1 2 3\n";
  EXPECT_THAT(read_with(R"({"red": {"reflectance": 0.5}})", "", same).warnings, IsEmpty())
      << "they are the same faces";
}

TEST(Materials, AGuessedReflectanceIsTold) {
  const std::string plain = "v 0 0 0\nv 1 0 0\nv 1 1 0\ng a\nf 1 2 3\ng b\nf 1 2 3\n";
  EXPECT_THAT(read_with("", "", plain).guesses,
              ElementsAre(HasSubstr("2 of 2 faces have no material")));
  EXPECT_THAT(read_with(R"({"a": {"reflectance": 0.1}})", "", plain).guesses,
              ElementsAre(HasSubstr("1 of 2 faces")));
  EXPECT_THAT(read_with(R"({"default": {"reflectance": 0.1}})", "", plain).guesses, IsEmpty());
  EXPECT_THAT(read_with("").guesses, IsEmpty());
}

TEST(Materials, AReportIsNoSidecar) {
  expect_error([&] { read_with("", R"({"version": "0.1.0", "command_line": "a", "unit": "m"})"); },
               ErrorCode::invalid_input, {"scene.json", "report"});
}

TEST(Materials, LeaveWhatTheyDoNotName) {
  const Scene scene = read_with(R"({"white": {"two_sided": true}})").scene;
  const Material& white = material_of(scene, 1);
  EXPECT_TRUE(white.two_sided);
  EXPECT_TRUE((white.rho == 0.8).all());
  EXPECT_TRUE((white.exitance == Rgb(1, 2, 3)).all());
  EXPECT_FALSE(material_of(scene, 0).two_sided);
}

TEST(Materials, MaySayTheSameTwice) {
  const Scene scene =
      read_with(R"({"red": {"exitance": 1, "exitance": 1.0}, "lamp": {}, "lamp": {}})").scene;
  EXPECT_TRUE((material_of(scene, 0).exitance == 1).all());
}

TEST(Materials, OverrideAGroupOnItsFacesOnly) {
  const Scene scene = read_with(R"({"lamp": {"exitance": 7, "reflectance": 0}})").scene;
  EXPECT_TRUE((material_of(scene, 2).exitance == 7).all());
  EXPECT_TRUE((material_of(scene, 2).rho == 0).all());
  EXPECT_TRUE((material_of(scene, 0).rho == Rgb(0.6, 0.1, 0.1)).all());
  EXPECT_TRUE((material_of(scene, 0).exitance == 0).all());
  EXPECT_EQ(material_of(scene, 2).name, "red (lamp)");
}

TEST(Materials, OverrideAGroupOfSeveralMaterialsKeepingTheirDifferences) {
  const Scene scene = read_with(R"({"room": {"exitance": 7}})").scene;
  EXPECT_TRUE((material_of(scene, 0).rho == Rgb(0.6, 0.1, 0.1)).all());
  EXPECT_TRUE((material_of(scene, 1).rho == 0.8).all());
  for (const std::size_t face : {0U, 1U})
    EXPECT_TRUE((material_of(scene, face).exitance == 7).all());
  EXPECT_TRUE((material_of(scene, 2).exitance == 0).all());
}

TEST(Materials, LetTheGroupWinOverTheMaterialWhateverTheOrder) {
  for (const char* json : {R"({"lamp": {"reflectance": 0.2}, "red": {"reflectance": 0.9}})",
                           R"({"red": {"reflectance": 0.9}, "lamp": {"reflectance": 0.2}})"}) {
    const Scene scene = read_with(json).scene;
    EXPECT_TRUE((material_of(scene, 0).rho == 0.9).all());
    EXPECT_TRUE((material_of(scene, 2).rho == 0.2).all());
  }
}

TEST(Materials, TakeANameAsAGroupFirst) {
  const std::string twins =
      "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl red\ng red\nf 1 2 3\ng other\nf 1 3 2\n";
  const Scene scene = read_with(R"({"red": {"reflectance": 0}})", "", twins).scene;
  EXPECT_TRUE((material_of(scene, 0).rho == 0).all());
  EXPECT_TRUE((material_of(scene, 1).rho == Rgb(0.6, 0.1, 0.1)).all());
}

TEST(Materials, WinOverTheSidecarsMaterials) {
  const std::string sidecar = R"({"materials": {"lamp": {"reflectance": 0.1, "exitance": 3},
                                                "white": {"reflectance": 0.4}}})";
  const Scene before = read_with("", sidecar).scene;
  EXPECT_TRUE((material_of(before, 2).rho == 0.1).all());
  EXPECT_TRUE((material_of(before, 1).rho == 0.4).all());
  const Scene after = read_with(R"({"red": {"reflectance": 0.7}})", sidecar).scene;
  EXPECT_TRUE((material_of(after, 0).rho == 0.7).all());
  EXPECT_TRUE((material_of(after, 1).rho == 0.4).all());
  EXPECT_TRUE((material_of(after, 2).rho == 0.7).all());
  EXPECT_TRUE((material_of(after, 2).exitance == 3).all());
}

TEST(Materials, MakeABadOrMissingMaterialGood) {
  const std::string undefined = "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl brick\nf 1 2 3\n";
  EXPECT_TRUE(
      (read_with(R"({"brick": {"reflectance": 0.3}})", "", undefined).scene.materials[0].rho == 0.3)
          .all());
  const TempDir folder;
  folder.write("scene.mtl", "newmtl red\nKd 1.5 0 0\nnewmtl white\nKd 0 0 0\n");
  const auto path = folder.write("scene.obj", two_squares);
  EXPECT_THROW(read_scene(path), Error);
  EXPECT_NO_THROW(read_scene(path, folder.write("m.json", R"({"red": {"reflectance": 1}})")));
}

TEST(Materials, NameTheDefaultMaterialOfAGroupAfterTheGroup) {
  const Scene scene = read_with(R"({"wall": {"reflectance": 0.3}})", "",
                                "v 0 0 0\nv 1 0 0\nv 1 1 0\ng wall\nf 1 2 3\n")
                          .scene;
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].name, "wall");
}

TEST(Materials, MayHaveComments) {
  EXPECT_NO_THROW(read_with("// paints\n{\"red\": {/* dull */ \"reflectance\": 0.1}}"));
}

struct BadJson {
  const char* name;
  const char* json;
  std::vector<std::string> sentence;
};

void PrintTo(const BadJson& file, std::ostream* out) { *out << file.name; }

class BadMaterials : public testing::TestWithParam<BadJson> {};

TEST_P(BadMaterials, AreRefusedNamingFileAndKey) {
  std::vector<std::string> parts = GetParam().sentence;
  parts.emplace_back("extra.json");
  expect_error([&] { read_with(GetParam().json); }, ErrorCode::invalid_input, parts);
}

const BadJson bad_materials[] = {
    {"Cut", "{\n\"red\": {", {"extra.json:2", "not JSON"}},
    {"Text", "red 0.5", {"extra.json:1", "not JSON"}},
    {"NotUtf8", "{\"\xFF\": 1}", {"extra.json:1", "not JSON"}},
    {"List", "[1, 2]", {"the whole file", "array"}},
    {"NameUnknown", R"({"blue": {}})", {"'blue'", "'room', 'lamp'", "'red', 'white'"}},
    {"EntryNotObject", R"({"red": 0.5})", {"'red'", "number"}},
    {"KeyUnknown", R"({"red": {"reflectanc": 0.5}})", {"'red'", "'reflectanc'", "'reflectance'"}},
    {"ReflectanceAboveOne", R"({"red": {"reflectance": 1.2}})", {"'red': 'reflectance'", "1.2"}},
    {"ReflectanceNegative", R"({"red": {"reflectance": [0, 0, -1]}})", {"-1"}},
    {"ReflectanceText",
     R"({"red": {"reflectance": "0.5"}})",
     {"'red': 'reflectance'", "[r, g, b]"}},
    {"ReflectanceTwo", R"({"red": {"reflectance": [1, 0]}})", {"'red': 'reflectance'"}},
    {"ReflectanceMixed", R"({"red": {"reflectance": [1, 0, "x"]}})", {"'red': 'reflectance'"}},
    {"ReflectanceNull", R"({"red": {"reflectance": null}})", {"'red': 'reflectance'"}},
    {"ExitanceNegative", R"({"lamp": {"exitance": -3}})", {"'lamp': 'exitance'", "-3"}},
    {"ExitanceTooLarge", R"({"lamp": {"exitance": 1e999}})", {"extra.json"}},
    {"TwoSidedNumber", R"({"red": {"two_sided": 1}})", {"'red': 'two_sided'", "true or false"}},
    {"NameTwice",
     R"({"red": {"reflectance": 0.5}, "lamp": {}, "red": {"reflectance": 0.6}})",
     {"'red' is there twice"}},
    {"KeyTwice",
     R"({"lamp": {}, "red": {"reflectance": [1, 0, 0], "exitance": 1, "reflectance": 1}})",
     {"'red': 'reflectance' is there twice"}},
};

INSTANTIATE_TEST_SUITE_P(Files, BadMaterials, testing::ValuesIn(bad_materials),
                         [](const auto& param) { return param.param.name; });

TEST(Sidecar, GivesUnitAndCameras) {
  const SceneFile file = read_with("", R"({"unit": "mm", "cameras": [
      {"name": "door", "position": [1, 2, 3], "target": [1, 2, 0], "up": [1, 0, 0],
       "vertical_fov": 55.5},
      {"position": [0, 0, 5], "direction": [0, 0, -1]}]})");
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_EQ(file.scene.unit, "mm");
  ASSERT_EQ(file.scene.cameras.size(), 2U);
  const Camera& door = file.scene.cameras[0];
  EXPECT_EQ(door.name, "door");
  EXPECT_EQ(door.position, Vec3(1, 2, 3));
  EXPECT_EQ(door.direction, Vec3(0, 0, -3));
  EXPECT_EQ(door.up, Vec3(1, 0, 0));
  EXPECT_EQ(door.vertical_fov, 55.5);
  EXPECT_EQ(file.scene.cameras[1].name, "camera 2");
  EXPECT_EQ(file.scene.cameras[1].direction, Vec3(0, 0, -1));
  EXPECT_EQ(file.scene.cameras[1].up, Camera{}.up);
}

TEST(Sidecar, IsOptional) {
  const Scene scene = read_with("").scene;
  EXPECT_EQ(scene.unit, "m");
  EXPECT_THAT(scene.cameras, IsEmpty());
}

TEST(Sidecar, WarnsOfKeysItDoesNotKnow) {
  EXPECT_THAT(read_with("", R"({"camera": []})").warnings,
              ElementsAre(HasSubstr("'camera' is not used")));
}

TEST(Sidecar, IsNotReadTwiceWhenItIsTheMaterialsFile) {
  const TempDir folder;
  folder.write("scene.mtl", two_materials);
  const auto path = folder.write("scene.obj", two_squares);
  const auto json = folder.write("scene.json", R"({"red": {"reflectance": 0.5}})");
  const SceneFile file = read_scene(path, json);
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_TRUE((material_of(file.scene, 0).rho == 0.5).all());
}

class BadSidecar : public testing::TestWithParam<BadJson> {};

TEST_P(BadSidecar, IsRefusedNamingFileAndKey) {
  std::vector<std::string> parts = GetParam().sentence;
  parts.emplace_back("scene.");
  expect_error([&] { read_with("", GetParam().json); }, ErrorCode::invalid_input, parts);
}

const BadJson bad_sidecars[] = {
    {"Cut", "{", {"scene.json:1", "not JSON"}},
    {"Number", "5", {"scene.json", "number"}},
    {"UnitNumber", R"({"unit": 5})", {"'unit'"}},
    {"UnitEmpty", R"({"unit": ""})", {"'unit'"}},
    {"CamerasObject", R"({"cameras": {}})", {"'cameras'", "list"}},
    {"CameraNumber", R"({"cameras": [5]})", {"camera 1", "number"}},
    {"KeyUnknown",
     R"({"cameras": [{"position": [0,0,0], "direction": [0,0,1], "fov": 5}]})",
     {"camera 1", "'fov'", "'vertical_fov'"}},
    {"NoPosition", R"({"cameras": [{"direction": [0,0,1]}]})", {"camera 1", "'position'"}},
    {"NoDirection", R"({"cameras": [{"position": [0,0,1]}]})", {"'target'", "'direction'"}},
    {"TargetAndDirection",
     R"({"cameras": [{"position": [0,0,1], "target": [0,0,0], "direction": [0,0,1]}]})",
     {"either"}},
    {"TargetIsPosition",
     R"({"cameras": [{"position": [0,0,1], "target": [0,0,1]}]})",
     {"camera 1", "no direction"}},
    {"PositionTwo",
     R"({"cameras": [{"position": [0,1], "direction": [0,0,1]}]})",
     {"camera 1: 'position'", "[x, y, z]"}},
    {"PositionText",
     R"({"cameras": [{"position": [0,1,"2"], "direction": [0,0,1]}]})",
     {"camera 1: 'position'"}},
    {"NameNumber",
     R"({"cameras": [{"name": 1, "position": [0,1,2], "direction": [0,0,1]}]})",
     {"camera 1: 'name'"}},
    {"FieldOfView",
     R"({"cameras": [{"position": [0,1,2], "direction": [0,0,1], "vertical_fov": 180}]})",
     {"camera 1: 'vertical_fov'", "(0, 180)"}},
    {"UpAlongDirection",
     R"({"cameras": [{"position": [0,1,2], "direction": [0,0,1], "up": [0,0,-2]}]})",
     {"'camera'", "parallel"}},
    {"MaterialUnknown", R"({"materials": {"blue": {}}})", {"'materials': 'blue'"}},
    {"MaterialsList", R"({"materials": []})", {"'materials'", "array"}},
};

INSTANTIATE_TEST_SUITE_P(Files, BadSidecar, testing::ValuesIn(bad_sidecars),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace halfshade
