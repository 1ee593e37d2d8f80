#include "io/read/read_scene.h"

#include "tests/support/files.h"

#include <gmock/gmock.h>
#include <string>

namespace halfshade {
namespace {

using test::expect_error;
using test::TempDir;
using testing::ElementsAre;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";

TEST(ReadScene, RefusesUnknownExtensionsAsAMistakeOfUse) {
  const TempDir folder;
  for (const char* name : {"scene.xyz", "scene", ".obj"})
    expect_error([&] { read_scene(folder.path() / name); }, ErrorCode::usage,
                 {name, ".obj", ".ply", ".off", ".gltf", ".glb", ".stl", ".dae", ".3ds"});
}

TEST(ReadScene, SaysWhatIsWrongWithAFileThatCannotBeRead) {
  const TempDir folder;
  for (const char* extension : {"obj", "ply", "off", "gltf", "glb", "stl", "dae", "3ds"}) {
    const std::string name = std::string("scene.") + extension;
    expect_error([&] { read_scene(folder.path() / ("no_" + name)); }, ErrorCode::invalid_input,
                 {"no_" + name, "no such file"});
    expect_error([&] { read_scene(folder.write(name, "")); }, ErrorCode::invalid_input,
                 {name, "empty"});
    std::filesystem::create_directory(folder.path() / ("dir_" + name));
    expect_error([&] { read_scene(folder.path() / ("dir_" + name)); }, ErrorCode::invalid_input,
                 {"dir_" + name, "directory"});
    expect_error([&] { read_scene(folder.write(name, "this is no scene\n")); },
                 ErrorCode::invalid_input, {name});
  }
  expect_error([&] { read_scene("/dev/zero/scene.obj"); }, ErrorCode::invalid_input,
               {"/dev/zero/scene.obj"});
  std::filesystem::create_symlink("/dev/zero", folder.path() / "endless.obj");
  expect_error([&] { read_scene(folder.path() / "endless.obj"); }, ErrorCode::invalid_input,
               {"regular file"});
}

TEST(ReadScene, SaysWhichMaterialsFileIsMissing) {
  const TempDir folder;
  const auto path = folder.write("scene.obj", triangle);
  expect_error([&] { read_scene(path, folder.path() / "none.json"); }, ErrorCode::invalid_input,
               {"none.json", "no such file"});
}

TEST(ReadScene, TakesExtensionsInAnyCaseAndAnyFileName) {
  const TempDir folder;
  for (const char* name : {"A.OBJ", "two words.Obj", "Größe.obj", "a.b.obj"}) {
    const auto path = folder.write(name, triangle);
    const Scene scene = read_scene(path).scene;
    EXPECT_EQ(scene.faces.size(), 1U);
    EXPECT_EQ(scene.source, path.string());
  }
}

TEST(ReadScene, ReadsRelativePaths) {
  const TempDir folder;
  folder.write("scene.mtl", "newmtl m\nKd 0 0 1\n");
  folder.write("scene.obj", "mtllib scene.mtl\nusemtl m\n" + triangle);
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const SceneFile file = read_scene("scene.obj");
  std::filesystem::current_path(before);
  EXPECT_TRUE((file.scene.materials.at(0).rho == Rgb(0, 0, 1)).all());
}

TEST(ReadScene, GivesTheSamePolygonsFromEveryFormatOfDoublePrecision) {
  const TempDir folder;
  const std::string points = "0.1 0 0\n1 0 0\n1 1 0.3\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty "
      "double z\nelement face 1\nproperty list int int vertex_indices\nend_header\n";
  for (const auto& path : {folder.write("a.obj", "v 0.1 0 0\nv 1 0 0\nv 1 1 0.3\nf 1 2 3\n"),
                           folder.write("a.off", "OFF 3 1 0\n" + points + "3 0 1 2\n"),
                           folder.write("a.ply", ply + points + "3 0 1 2\n")}) {
    const Scene scene = read_scene(path).scene;
    EXPECT_THAT(scene.vertices, ElementsAre(Vec3(0.1, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0.3)));
    EXPECT_THAT(scene.faces.at(0).vertices, ElementsAre(0, 1, 2));
    EXPECT_THAT(scene.groups, ElementsAre("default"));
    EXPECT_EQ(scene.materials.at(0).name, "default");
  }
}

TEST(ReadScene, ValidatesWhatItReads) {
  const TempDir folder;
  const auto far = folder.write("far.obj", "v 1e10 0 0\nv 10000000001 0 0\nv 1e10 1 0\nf 1 2 3\n");
  expect_error([&] { read_scene(far); }, ErrorCode::invalid_input, {"far.obj", "double precision"});
  const auto huge = folder.write("huge.off", "OFF 3 1 0\n1e200 0 0\n0 0 0\n0 1 0\n3 0 1 2\n");
  expect_error([&] { read_scene(huge); }, ErrorCode::invalid_input, {"huge.off", "1e+200"});
}

}  // namespace
}  // namespace halfshade
