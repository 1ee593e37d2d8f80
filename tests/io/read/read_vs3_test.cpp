#include "tests/support/scene_texts.h"

#include <gmock/gmock.h>

namespace halfshade {
namespace {

using test::expect_refused;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SceneFile read_vs3(const std::string& text) { return test::read_text("scene.vs3", text); }

const std::string vs3_vertices =
    "T a title # with a mark\nC encl=1 list=2\nF 3\n!  #  x  y  z\nV 1 0.1 0 0\nV 2 1. 0. 0.\n"
    "v 3 1 1 0 ! the third\nV 4 0 1 0\nV 5 0 0 1\n";

TEST(ReadVs3, MakesGroupsOfNamesAndReflectancesOfEmissivities) {
  const SceneFile file = read_vs3(vs3_vertices +
                                  "S 1 1 2 3 4 0 0 0.9 floor\nS 2 1 2 5 0 0 0 .25\n"
                                  "S 3 5 2 1 0 0 1 0.9 more / joined\nEnd of data\nnonsense\n");
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_THAT(file.guesses, IsEmpty());
  const Scene& scene = file.scene;
  EXPECT_EQ(scene.vertices.at(0), Vec3(0.1, 0, 0));
  EXPECT_THAT(scene.groups, ElementsAre("floor", "surface 2"));
  ASSERT_EQ(scene.faces.size(), 3U);
  EXPECT_THAT(scene.faces[0].vertices, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(scene.faces[1].vertices, ElementsAre(0, 1, 4));
  EXPECT_EQ(scene.faces[2].group, 0) << "it is combined with the first";
  EXPECT_EQ(scene.faces[2].line, 12);
  ASSERT_EQ(scene.materials.size(), 2U);
  EXPECT_DOUBLE_EQ(scene.materials[0].rho[0], 0.1);
  EXPECT_EQ(scene.materials[1].name, "emissivity 0.25");
  EXPECT_EQ(scene.materials[1].rho[2], 0.75);
}

TEST(ReadVs3, TakesObstructionsForBlackAndSaysSo) {
  const SceneFile file = read_vs3(vs3_vertices + "S 1 1 2 3 4 0 0 0.9 floor\nO 2 1 2 5 0\n");
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("'obstructions'")));
  EXPECT_THAT(file.scene.groups, ElementsAre("floor", "obstructions"));
  EXPECT_EQ(file.scene.materials.at(1).rho[0], 0);
}

TEST(ReadVs3, RefusesWhatItWouldGetWrong) {
  const std::string floor = "S 1 1 2 3 4 0 0 0.9 floor\n";
  const auto refuse = [](const std::string& text, const std::vector<std::string>& parts) {
    SCOPED_TRACE(text);
    expect_refused("scene.vs3", text, parts);
  };
  refuse(vs3_vertices + floor + "M 2 4 3 2 1 1 0 0.9 mask\n", {"scene.vs3:11", "masking"});
  refuse(vs3_vertices + floor + "N 2 4 3 2 1 1 0 0.9 hole\n", {"scene.vs3:11", "null surfaces"});
  refuse("F 3a\n", {"scene.vs3:1", "F '3a'"});
  refuse(vs3_vertices + "X 1 2 3\n", {"transformations"});
  refuse(vs3_vertices + "S 1 1 2 3 4 0 0 1.2 floor\n", {"surface 1", "emissivity 1.2", "[0, 1]"});
  refuse(vs3_vertices + "S 1 1 2 3 9 0 0 0.9 floor\n",
         {"scene.vs3:10", "surface 1", "vertex 9", "from 1 to 5"});
  refuse(vs3_vertices + "S 1 1 2 0 4 0 0 0.9 floor\n", {"vertex 0", "from 1 to 5"});
  refuse(vs3_vertices + floor + "O 2 1 2 7 0\n", {"surface 2", "vertex 7"});
  refuse("S 1 1 2 3 4 0 0 0.9 floor\n", {"vertex 1", "no vertices"});
  refuse(vs3_vertices + "S 2 1 2 3 4 0 0 0.9 floor\n", {"surface 2", "surface 1 is expected"});
  refuse(vs3_vertices + "V 7 0 0 0\n", {"vertex 7", "vertex 6 is expected"});
  refuse(vs3_vertices + "S 1 1 2 3 4 5 0 0.9 floor\n", {"the base is surface 5", "1 surfaces"});
  const std::string part = "V 6 0.5 0.5 0\nV 7 0.6 0.5 0\nV 8 0.5 0.6 0\n";
  EXPECT_NO_THROW(read_vs3(vs3_vertices + part + floor + "S 2 6 7 8 0 1 0 0.9 part\n"));
  refuse(vs3_vertices + part + floor + "S 2 6 8 7 0 1 0 0.9 part\n", {"surface 2", "other way"});
  refuse(vs3_vertices + part + floor + "S 2 6 7 5 0 1 0 0.9 part\n", {"surface 2", "surface 1"});
  refuse(vs3_vertices + "S 1 1 2 3 4 0 3 0.9 floor\n", {"combined with surface 3"});
  refuse(vs3_vertices + "S 1 1 2 3 4\n", {"8 numbers"});
  refuse(vs3_vertices + "V 6 0 0\n", {"3 coordinates"});
  refuse(vs3_vertices + "Q 6 0 0\n", {"'Q'"});
  refuse(vs3_vertices, {"no faces"});
}

}  // namespace
}  // namespace halfshade
