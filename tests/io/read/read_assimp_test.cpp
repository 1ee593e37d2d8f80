#include "io/files/little_endian.h"
#include "io/picture/picture.h"
#include "io/read/read_scene.h"
#include "tests/support/assimp_samples.h"
#include "tests/support/files.h"
#include "tests/support/gltf_samples.h"
#include "tests/support/scene_texts.h"

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <string>

namespace halfshade {
namespace {

using nlohmann::json;
using test::as_glb;
using test::collada;
using test::expect_error;
using test::expect_refused;
using test::gltf_triangle;
using test::read_text;
using test::TempDir;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

Vec3 normal(const Scene& scene, int face) {
  const std::vector<Vec3> p = face_corners(scene, face);
  return (p[1] - p[0]).cross(p[2] - p[0]);
}

int face_in_group(const Scene& scene, const std::string& group) {
  for (std::size_t f = 0; f < scene.faces.size(); ++f)
    if (scene.groups[static_cast<std::size_t>(scene.faces[f].group)] == group)
      return static_cast<int>(f);
  ADD_FAILURE() << "no face in " << group;
  return 0;
}

TEST(ReadGltf, RefusesChunksLongerThanTheFile) {
  const TempDir folder;
  for (const std::size_t at : {12U, 14U, 15U}) {  // the length of the first chunk
    std::string bytes = as_glb(gltf_triangle());
    bytes[at] = '\x7f';
    expect_error([&] { read_scene(folder.write("a.glb", bytes)); }, ErrorCode::invalid_input,
                 {"a.glb", at == 12 ? "" : "bytes is announced"});
  }
}

TEST(ReadGltf, AppliesTransformsNamesAndMaterials) {
  const TempDir folder;
  for (const auto& path : {folder.write("a.gltf", gltf_triangle().dump()),
                           folder.write("b.glb", as_glb(gltf_triangle()))}) {
    const Scene scene = read_scene(path).scene;
    ASSERT_EQ(scene.faces.size(), 2U);
    EXPECT_THAT(scene.groups, ElementsAre("plain", "twin"));
    EXPECT_THAT(face_corners(scene, face_in_group(scene, "plain")),
                ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)));
    EXPECT_THAT(face_corners(scene, face_in_group(scene, "twin")),
                UnorderedElementsAre(Vec3(10, 20, 30), Vec3(8, 20, 30), Vec3(10, 21, 30)));
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].name, "glow");
    EXPECT_TRUE((scene.materials[0].rho == Rgb(0.25, 0.5, 0.75)).all());
    EXPECT_TRUE((scene.materials[0].exitance == Rgb(1, 0.5, 0)).all());
    EXPECT_TRUE(scene.materials[0].two_sided);
  }
}

/// A red and a green texel side by side.
std::string red_and_green() {
  const TempDir folder;
  Picture picture{2, 1, 1, {255, 0, 0, 0, 255, 0}, {}};
  write_png(picture, folder.path() / "two.png");
  return test::contents(folder.path() / "two.png");
}

/// The triangle with (0, 0), (1, 0), (0, 1) of its picture, from the upper left, at its corners.
json painted_gltf(const std::string& uri) {
  json gltf = gltf_triangle();
  std::string places;
  for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, 1.F}) detail::put(places, x);
  gltf["buffers"].push_back(
      {{"byteLength", places.size()},
       {"uri", "data:application/octet-stream;base64," + test::base64(places)}});
  gltf["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", places.size()}});
  gltf["accessors"].push_back(
      {{"bufferView", 2}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
  gltf["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2;
  gltf["images"] = {{{"uri", uri}, {"mimeType", "image/png"}}};
  gltf["textures"] = {{{"source", 0}}};
  gltf["materials"][0]["emissiveFactor"] = {0, 0, 0};
  gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  return gltf;
}

void expect_red_then_green(const Scene& scene) {
  ASSERT_EQ(scene.paints.size(), 2U);  // of both nodes
  const auto paint_on = [&](const char* group) {
    return scene.paints.at(at(scene.faces[at(face_in_group(scene, group))].paint));
  };
  const Paint paint = paint_on("plain"), twin = paint_on("twin");
  EXPECT_TRUE(colour_at(paint, {0.1, 0.2, 0}).isApprox(Rgb(1, 0, 0)));
  EXPECT_TRUE(colour_at(paint, {0.9, 0.05, 0}).isApprox(Rgb(0, 1, 0)));
  EXPECT_TRUE(colour_at(twin, {9.9, 20.1, 30}).isApprox(Rgb(1, 0, 0)));
  EXPECT_TRUE(colour_at(twin, {8.1, 20.05, 30}).isApprox(Rgb(0, 1, 0)));
  EXPECT_TRUE((scene.materials[0].rho == Rgb(0.25, 0.5, 0.75)).all());
}

TEST(ReadGltf, TakesPicturesInItAndBesideIt) {
  const std::string data = "data:image/png;base64," + test::base64(red_and_green());
  const SceneFile inside = read_text("a.gltf", painted_gltf(data).dump());
  EXPECT_THAT(inside.warnings, IsEmpty());
  expect_red_then_green(inside.scene);

  const TempDir folder;
  folder.write("two.png", red_and_green());
  const SceneFile beside = read_scene(folder.write("a.gltf", painted_gltf("two.png").dump()));
  EXPECT_THAT(beside.warnings, IsEmpty());
  expect_red_then_green(beside.scene);
  EXPECT_EQ(beside.files.back().filename(), "two.png");
}

TEST(ReadGltf, SaysWhatIsNotDoneWithPictures) {
  const SceneFile missing = read_text("a.gltf", painted_gltf("none.png").dump());
  EXPECT_THAT(missing.warnings, ElementsAre(HasSubstr("there is no picture 'none.png'")));
  json moved = painted_gltf("data:image/png;base64," + test::base64(red_and_green()));
  moved["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
       ["KHR_texture_transform"] = {{"scale", {2, 2}}};
  moved["extensionsUsed"] = {"KHR_texture_transform"};
  EXPECT_THAT(read_text("a.gltf", moved.dump()).warnings,
              Contains(HasSubstr("moved, turned or scaled")));
  expect_error(
      [] {
        read_text("a.gltf", painted_gltf("data:image/png;base64," + test::base64("none")).dump());
      },
      ErrorCode::invalid_input, {"damaged"});
}

TEST(ReadGltf, CutsLampsAlongTheirPictures) {
  json gltf = painted_gltf("data:image/png;base64," + test::base64(red_and_green()));
  gltf["materials"][0]["emissiveFactor"] = {1, 1, 1};
  gltf["materials"][0]["emissiveTexture"] = {{"index", 0}};
  gltf["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 40;
  const Scene scene = read_text("a.gltf", gltf.dump()).scene;
  Rgb most = Rgb::Zero();
  for (const Material& material : scene.materials) most = most.max(material.exitance);
  EXPECT_GT(scene.faces.size(), 3U);
  EXPECT_NEAR(most[0], 40, 1);
  EXPECT_NEAR(most[1], 40, 1);
  EXPECT_EQ(most[2], 0);
}

TEST(ReadGltf, KeepsTheFrontOfMirroredNodes) {
  const Scene scene = read_text("a.gltf", gltf_triangle().dump()).scene;
  EXPECT_EQ(normal(scene, face_in_group(scene, "plain")), Vec3(0, 0, 1));
  EXPECT_EQ(normal(scene, face_in_group(scene, "twin")), Vec3(0, 0, 2));
}

TEST(ReadGltf, TakesAMaterialAsOneSidedAndDarkUnlessItSaysOtherwise) {
  json gltf = gltf_triangle();
  gltf["materials"][0] = {{"name", "m"}};
  const Material m = read_text("a.gltf", gltf.dump()).scene.materials.at(0);
  EXPECT_FALSE(m.two_sided);
  EXPECT_TRUE((m.exitance == 0).all());
}

TEST(ReadGltf, GivesMeshesWithoutMaterialTheDefaultOne) {
  json gltf = gltf_triangle();
  gltf.erase("materials");
  gltf["meshes"][0]["primitives"][0].erase("material");
  const Material m = read_text("a.gltf", gltf.dump()).scene.materials.at(0);
  EXPECT_EQ(m.name, "default");
  EXPECT_TRUE((m.rho == Material{}.rho).all());
}

TEST(ReadGltf, MultipliesTheEmissionByItsStrength) {
  json gltf = gltf_triangle();
  gltf["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 40;
  const TempDir folder;
  for (const auto& path :
       {folder.write("a.gltf", gltf.dump()), folder.write("b.glb", as_glb(gltf))})
    EXPECT_TRUE((read_scene(path).scene.materials.at(0).exitance == Rgb(40, 20, 0)).all());
}

TEST(ReadGltf, KeepsMaterialsOfTheSameNameOrWithoutOneApart) {
  for (const char* name : {"paint", ""}) {
    json gltf = gltf_triangle();
    for (int i = 0; i < 2; ++i) {
      gltf["materials"][i] = {
          {"pbrMetallicRoughness", {{"baseColorFactor", {0.25 * i, 0.25 * i, 0.25 * i, 1}}}}};
      if (*name != '\0') gltf["materials"][i]["name"] = name;
    }
    gltf["meshes"].push_back(gltf["meshes"][0]);
    gltf["meshes"][1]["primitives"][0]["material"] = 1;
    gltf["nodes"][1]["mesh"] = 1;
    const TempDir folder;
    const Scene scene = read_scene(folder.write("a.gltf", gltf.dump())).scene;
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_NE(scene.materials[0].name, scene.materials[1].name);
    for (const auto& [group, rho] : {std::pair("plain", 0.0), std::pair("twin", 0.25)}) {
      const Face& face = scene.faces[static_cast<std::size_t>(face_in_group(scene, group))];
      EXPECT_TRUE((scene.materials[static_cast<std::size_t>(face.material)].rho == rho).all());
    }
  }
}

TEST(ReadGltf, TakesMaterialsFromAFileByNodeName) {
  const TempDir folder;
  const Scene scene = read_scene(folder.write("a.gltf", gltf_triangle().dump()),
                                 folder.write("m.json", R"({"twin": {"exitance": 9}})"))
                          .scene;
  const int lit = scene.faces[static_cast<std::size_t>(face_in_group(scene, "twin"))].material;
  const int unlit = scene.faces[static_cast<std::size_t>(face_in_group(scene, "plain"))].material;
  EXPECT_TRUE((scene.materials[static_cast<std::size_t>(lit)].exitance == 9).all());
  EXPECT_TRUE((scene.materials[static_cast<std::size_t>(unlit)].exitance == Rgb(1, 0.5, 0)).all());
}

TEST(ReadGltf, RefusesTruncatedFiles) {
  const std::string text = gltf_triangle().dump(), binary = as_glb(gltf_triangle());
  for (const std::size_t size : {std::size_t{1}, text.size() / 2, text.size() - 1})
    expect_refused("a.gltf", text.substr(0, size), {"a.gltf"});
  for (const std::size_t size : {std::size_t{3}, std::size_t{12}, binary.size() / 2})
    expect_refused("a.glb", binary.substr(0, size), {"a.glb"});
}

TEST(ReadCollada, KeepsPolygonsAndMaterials) {
  const Scene scene = read_text("a.dae", collada("Y_UP", "1")).scene;
  ASSERT_EQ(scene.faces.size(), 1U);
  EXPECT_THAT(face_corners(scene, 0), ElementsAre(Vec3(0, 0, 4), Vec3(1, 0, 4), Vec3(1, 1, 4),
                                                  Vec3(0.5, 2, 4), Vec3(0, 1, 4)));
  EXPECT_THAT(scene.groups, ElementsAre("table"));
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].name, "paint");
  EXPECT_TRUE((scene.materials[0].rho == Rgb(0.25, 0.5, 0.75)).all());
  EXPECT_TRUE((scene.materials[0].exitance == Rgb(3, 2, 1)).all());
}

TEST(ReadCollada, RefusesTruncatedFiles) {
  const std::string text = collada("Y_UP", "1");
  for (const std::size_t size : {std::size_t{30}, text.size() / 3, text.size() / 2})
    expect_refused("a.dae", text.substr(0, size), {"a.dae"});
}

TEST(Read3ds, KeepsTrianglesAndMaterials) {
  const Scene scene = read_text("a.3ds", test::three_ds()).scene;
  ASSERT_EQ(scene.faces.size(), 2U);
  // Assimp turns the third axis, which is up in this format, to the second.
  EXPECT_THAT(face_corners(scene, 0), ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, -1)));
  EXPECT_THAT(face_corners(scene, 1), ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, -1), Vec3(0, 0, -1)));
  const Material& material = scene.materials[static_cast<std::size_t>(scene.faces[0].material)];
  EXPECT_EQ(material.name, "paint");
  EXPECT_NEAR(material.rho[0], 0.2, 1e-6);
  EXPECT_NEAR(material.rho[1], 0.4, 1e-6);
  EXPECT_NEAR(material.rho[2], 0.6, 1e-6);
}

TEST(Read3ds, RefusesTruncatedFiles) {
  const std::string bytes = test::three_ds();
  for (const std::size_t size : {std::size_t{5}, bytes.size() / 3, bytes.size() / 2})
    expect_refused("a.3ds", bytes.substr(0, size), {"a.3ds"});
}

}  // namespace
}  // namespace halfshade
