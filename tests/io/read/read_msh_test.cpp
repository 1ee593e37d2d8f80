#include "tests/support/msh_bytes.h"
#include "tests/support/scene_texts.h"

#include <gmock/gmock.h>

namespace halfshade {
namespace {

using test::expect_refused;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SceneFile read_msh(const std::string& text) { return test::read_text("scene.msh", text); }

std::string section(const std::string& name, const std::string& content) {
  return "$" + name + "\n" + content + "$End" + name + "\n";
}

const std::string old_format = section("MeshFormat", "2.2 0 8\n");
const std::string new_format = section("MeshFormat", "4.1 0 8\n");
const std::string group_names =
    section("PhysicalNames", "3\n1 1 \"rim\"\n2 1 \"the floor\"\n2 7 \"lid\"\n");
const std::string nodes = section("Nodes", "4\n1 0.1 0 0\n2 1 0 0\n30 1 1 0\n4 0 1 0\n");
const std::string new_nodes =
    section("Nodes", "2 4 1 30\n2 1 0 3\n1\n2\n30\n0.1 0 0\n1 0 0\n1 1 0\n0 1 0 1\n4\n0 1 0\n");

TEST(ReadMsh, ReadsFormat2WithPhysicalGroups) {
  const SceneFile file =
      read_msh(old_format + group_names + section("Comments", "what else\nthere is\n") + nodes +
               section("Elements",
                       "5\n1 15 2 0 1 1\n2 1 2 1 1 1 2\n3 3 2 1 1 1 2 30 4\n4 2 2 9 1 1 2 30\n"
                       "5 2 0 1 30 4\n"));
  const Scene& scene = file.scene;
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_EQ(scene.vertices.at(0), Vec3(0.1, 0, 0));
  ASSERT_EQ(scene.faces.size(), 3U);
  EXPECT_THAT(scene.faces[0].vertices, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(scene.faces[2].vertices, ElementsAre(0, 2, 3));
  EXPECT_EQ(scene.groups[static_cast<std::size_t>(scene.faces[0].group)], "the floor");
  EXPECT_EQ(scene.groups[static_cast<std::size_t>(scene.faces[1].group)], "physical 9");
  EXPECT_EQ(scene.groups[static_cast<std::size_t>(scene.faces[2].group)], "default");
}

TEST(ReadMsh, ReadsFormat41WithEntities) {
  const std::string entities = section("Entities",
                                       "1 0 3 0\n4 0 0 0 0\n5 0 0 0 1 1 0 1 1 0\n"
                                       "6 0 0 0 1 1 0 2 7 1 0\n8 0 0 0 1 1 0 0 0\n");
  const SceneFile file =
      read_msh(new_format + group_names + entities + new_nodes +
               section("Elements",
                       "4 5 1 5\n1 1 1 1\n1 1 2\n2 5 3 1\n2 1 2 30 4\n2 6 2 2\n3 1 2 30\n"
                       "4 1 30 4\n3 1 4 1\n5 1 2 30 4\n"));
  const Scene& scene = file.scene;
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("2 physical groups"),
                                         HasSubstr("1 volume elements are not used")));
  ASSERT_EQ(scene.faces.size(), 3U);
  EXPECT_THAT(scene.faces[0].vertices, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(scene.faces[2].vertices, ElementsAre(0, 2, 3));
  EXPECT_EQ(scene.groups[static_cast<std::size_t>(scene.faces[0].group)], "the floor");
  EXPECT_EQ(scene.groups[static_cast<std::size_t>(scene.faces[1].group)], "lid");
}

TEST(ReadMsh, RefusesWhatItWouldGetWrong) {
  const auto refuse = [](const std::string& text, const std::vector<std::string>& parts) {
    SCOPED_TRACE(text);
    expect_refused("scene.msh", text, parts);
  };
  refuse("$NOD\n1\n", {"scene.msh:1", "$MeshFormat"});
  refuse(section("MeshFormat", "4 0 8\n"), {"format '4'", "4.1 or 2.2"});
  refuse(section("MeshFormat", "4.1 2 8\n"), {"scene.msh:2", "'2'", "0 (text) or 1 (binary)"});
  refuse(old_format + nodes + section("Elements", "1\n1 9 2 1 1 1 2 30 4 1 2\n"),
         {"higher order", "Mesh.ElementOrder"});
  refuse(old_format + nodes + section("Elements", "1\n1 77 2 1 1 1 2\n"), {"type 77"});
  refuse(old_format + nodes + section("Elements", "1\n1 2 2 1 1 1 2 3\n"), {"node 3", "not there"});
  refuse(old_format + nodes + section("Elements", "1\n1 2 2 -1 1 1 2 30\n"),
         {"group -1", "other way round"});
  refuse(old_format + nodes + section("Elements", "2\n1 2 2 1 1 1 2 30\n"), {"3 numbers"});
  refuse(old_format + section("Nodes", "2\n1 0 0 0\n1 0 0 0\n"), {"node 1", "twice"});
  refuse(old_format + "$Nodes\n900000000000\n1 0 0 0\n", {"ends before a node"});
  refuse(new_format + section("PartitionedEntities", "1\n"), {"partitions"});
  refuse(old_format + "stray\n", {"'stray'"});
  refuse(old_format + "$Fields\n", {"ends before $EndFields"});
  refuse(old_format + nodes, {"no faces"});
}

void expect_same(const SceneFile& a, const SceneFile& b) {
  EXPECT_EQ(a.scene.vertices, b.scene.vertices);
  EXPECT_EQ(a.scene.groups, b.scene.groups);
  EXPECT_EQ(a.warnings.size(), b.warnings.size());
  ASSERT_EQ(a.scene.faces.size(), b.scene.faces.size());
  for (std::size_t f = 0; f < a.scene.faces.size(); ++f) {
    EXPECT_EQ(a.scene.faces[f].vertices, b.scene.faces[f].vertices);
    EXPECT_EQ(a.scene.faces[f].group, b.scene.faces[f].group);
  }
}

TEST(ReadMsh, ReadsBinaryFilesAsTheirTextTwins) {
  for (const bool swapped : {false, true}) {
    const SceneFile two = read_msh(test::msh_binary_2(swapped));
    expect_same(two, read_msh(test::msh_text_2()));
    EXPECT_THAT(two.scene.groups, ElementsAre("the floor", "lid", "physical 9"));
    EXPECT_THAT(two.warnings, ElementsAre(HasSubstr("1 volume elements are not used")));
    const SceneFile four = read_msh(test::msh_binary_4(swapped));
    expect_same(four, read_msh(test::msh_text_4()));
    EXPECT_THAT(four.scene.groups, ElementsAre("the floor", "lid"));
    EXPECT_EQ(four.scene.vertices.at(0), Vec3(0.1, 0, 0));
  }
}

TEST(ReadMsh, RefusesBinaryFilesThatAreCutShort) {
  for (const std::string& whole : {test::msh_binary_2(false), test::msh_binary_4(true)})
    for (std::size_t size = 24; size < whole.find("$EndElements"); size += 7)
      expect_refused("scene.msh", whole.substr(0, size), {"scene.msh"});
}

TEST(ReadMsh, RefusesBinaryFilesThatItWouldGetWrong) {
  const auto refuse = [](const std::string& text, const std::vector<std::string>& parts) {
    expect_refused("scene.msh", text, parts);
  };
  const auto head = [] {
    test::MshBytes out(false);
    out.text("$MeshFormat\n2.2 1 8\n").ints(1).text("\n$EndMeshFormat\n");
    return out.text("$Nodes\n1\n").ints(1).reals(0, 0, 0).text("\n$EndNodes\n");
  };
  refuse("$MeshFormat\n4.1 1 4\n", {"4.1 1 4", "8 bytes"});
  refuse(test::MshBytes(false).text("$MeshFormat\n4.1 1 8\n").ints(2).bytes(),
         {"order of bytes is 2"});
  refuse(head().text("$Elements\n1\n").ints(2, 1, 0, 1, 1, 1, 9).text("\n$EndElements\n").bytes(),
         {"element 1 names node 9"});
  refuse(head().text("$Elements\n1\n").ints(9, 1, 0, 1, 1, 1, 1, 1, 1, 1).bytes(),
         {"Mesh.ElementOrder"});
  refuse(head().text("$Elements\n1\n").ints(2, 5, 0, 1, 1, 1, 1).bytes(),
         {"5 elements", "1 are left"});
  refuse(head().text("$Nodes\n-7\n").bytes(), {"-7"});
  refuse(head().text("$Nodes\n900000000000\n").bytes(), {"cut short"});
  refuse(head().text("stray\n").bytes(), {"'stray'"});
}

TEST(ReadMsh, SaysThatANamedGroupHasNoFaces) {
  const test::TempDir folder;
  const auto scene = folder.write("scene.msh", old_format + group_names + nodes +
                                                   section("Elements", "1\n3 3 2 1 1 1 2 30 4\n"));
  const auto materials = folder.write("materials.json", R"({"lid": {"reflectance": 0.1}})");
  test::expect_error([&] { read_scene(scene, materials); }, ErrorCode::invalid_input,
                     {"'lid'", "has no faces"});
}

}  // namespace
}  // namespace halfshade
