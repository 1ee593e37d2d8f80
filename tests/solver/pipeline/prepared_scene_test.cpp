#include "solver/pipeline/prepared_scene.h"

#include "meshing/rays/visibility.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/mesh_scene.h"
#include "solver/pipeline/solve.h"
#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"
#include "tests/support/triangle_soups.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(PreparedScene, MakesEverythingOnce) {
  Scene input = test::table_scene();
  input.unit = "cm";
  const PreparedScene prepared(input);
  EXPECT_EQ(prepared.scene().surfaces.size(), 3u);
  EXPECT_EQ(prepared.unit(), "cm");
  EXPECT_EQ(prepared.repair().name, "repair");
  EXPECT_EQ(prepared.repair().count, 3u);
  EXPECT_EQ(&prepared.direct_light(), &prepared.direct_light());
  EXPECT_EQ(&prepared.opaque(), &prepared.opaque());
  EXPECT_EQ(&prepared.visibility(), &prepared.visibility());
  ASSERT_EQ(prepared.direct_light().emitters().size(), 1u);
  EXPECT_EQ(prepared.direct_light().emitters()[0], 1);
  EXPECT_FALSE(prepared.visibility().soup().triangles.empty());
}

TEST(UsePrepared, DoesWithoutContactLinesWhereTheyTakeTooMuchAndSaysSo) {
  const Scene soup = test::unit_soup(15, 1);
  const auto contacts = [](const PreparedScene& prepared) {
    std::size_t count = 0;
    for (const Surface& surface : prepared.scene().surfaces) count += surface.contacts.size();
    return count;
  };
  const Warning warning = contacts_warning();
  EXPECT_GT(use_prepared(soup, {}, {}, contacts), 50u);
  EXPECT_EQ(use_prepared(soup, {20, warning}, {}, contacts), 0u);
  int calls = 0;
  const auto picky = [&](const PreparedScene& prepared) {
    ++calls;
    if (contacts(prepared) > 0) throw Error(ErrorCode::too_large, "test", "too much");
    return prepared.warnings();
  };
  const std::vector<Warning> warnings = use_prepared(soup, {1e6, warning}, {}, picky);
  EXPECT_EQ(calls, 2);
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings.front().sentence, warning.sentence);
  EXPECT_EQ(warning.sentence.find("--max-elements"), std::string::npos);
}

TEST(PreparedScene, GivesEachPipelineTheSameAsTheSceneDoes) {
  SolveOptions options;
  options.elements = 300;
  const PreparedScene prepared(test::table_scene());
  const MeshResult meshed = mesh_scene(prepared);
  const SolveResult first = solve(prepared, options), again = solve(prepared, options);
  const SolveResult expected = solve(test::table_scene(), options);
  EXPECT_EQ(meshed.found.curves.size(), mesh_scene(test::table_scene()).found.curves.size());
  EXPECT_TRUE((first.solution.radiosity == expected.solution.radiosity).all());
  EXPECT_TRUE((again.solution.radiosity == expected.solution.radiosity).all());
  ASSERT_EQ(first.stages.size(), expected.stages.size());
  for (std::size_t k = 0; k < first.stages.size(); ++k)
    EXPECT_EQ(first.stages[k].name, expected.stages[k].name);
}

TEST(PreparedScene, RefusesScenesThatCannotBeUsed) {
  Scene dark = test::table_scene();
  dark.materials[1].exitance = Rgb::Zero();
  test::expect_error([&] { PreparedScene{dark}; }, ErrorCode::invalid_input, {"emit"});
  Scene broken = test::table_scene();
  broken.faces[0].vertices[0] = 99;
  test::expect_error([&] { PreparedScene{broken}; }, ErrorCode::invalid_input, {"vertex 100"});
}

}  // namespace
}  // namespace halfshade
