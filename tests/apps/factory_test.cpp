#include "io/read/read_scene.h"
#include "meshing/core/planar.h"
#include "meshing/repair/repair.h"
#include "tests/support/files.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace halfshade {
namespace {

const std::string interpreter = "/usr/bin/python3";

test::Outcome make_factory(const std::vector<std::string>& arguments,
                           const std::filesystem::path& folder) {
  std::vector<std::string> line = {interpreter, "-B", test::data_file("factory.py").string()};
  line.insert(line.end(), arguments.begin(), arguments.end());
  return test::run_program(line, folder);
}

TEST(Factory, HasThePolygonsAndThePowerOfItsPage) {
  if (!std::filesystem::exists(interpreter)) GTEST_SKIP() << "needs python3";
  const test::TempDir folder;
  const test::Outcome made = make_factory({"8", "."}, folder.path());
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.out, "4496 polygons\n");
  const SceneFile file = read_scene(folder.path() / "factory_8.obj");
  EXPECT_EQ(file.scene.faces.size(), 4496U);
  EXPECT_TRUE(file.warnings.empty());
  const SoundScene scene = make_sound(file.scene);
  double power = 0;
  for (const Surface& surface : scene.surfaces)
    power += area(surface) * scene.materials[at(surface.material)].exitance[0];
  EXPECT_NEAR(power, 5 * 864, 1e-6);
}

TEST(Factory, SaysWhatItNeeds) {
  if (!std::filesystem::exists(interpreter)) GTEST_SKIP() << "needs python3";
  const test::TempDir folder;
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{}, {"0", "."}, {"many", "."}, {"8"}}) {
    const test::Outcome outcome = make_factory(wrong, folder.path());
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.err, "usage: factory.py MACHINES FOLDER, with at least one machine\n");
  }
}

}  // namespace
}  // namespace halfshade
