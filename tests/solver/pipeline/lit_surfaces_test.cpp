#include "solver/pipeline/lit_surfaces.h"

#include "meshing/repair/repair.h"
#include "tests/support/random_scene.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace halfshade {
namespace {

/// Materials of the surfaces that are lit.
std::vector<int> lit_materials(const Scene& scene) {
  const SoundScene sound = make_sound(scene);
  std::vector<int> materials;
  for (const int s : lit_surfaces(sound, 1e-4)) materials.push_back(sound.surfaces[at(s)].material);
  std::sort(materials.begin(), materials.end());
  return materials;
}

/// A floor and a table of material 0 under a lamp of material 1.
const Scene table = test::table_scene();

TEST(LitSurfaces, AreAllInARoomAndWhereNothingShines) {
  EXPECT_EQ(lit_materials(table), (std::vector{0, 0, 1}));
  Scene dark = table;
  dark.materials[1].exitance.setZero();
  EXPECT_EQ(lit_materials(dark).size(), 3u);
  for (const double unit : {1e-30, 1e30}) {
    Scene scene = table;
    for (Vec3& p : scene.vertices) p *= unit;
    for (Material& material : scene.materials) material.exitance *= 1e150;
    EXPECT_EQ(lit_materials(scene), (std::vector{0, 0, 1})) << unit;
  }
}

TEST(LitSurfaces, AreNotWhatIsFarAwayOrTiny) {
  for (const auto& [distance, extent] :
       {std::pair(1e3, 1e2), std::pair(1e9, 1e8), std::pair(3., 1e-9)})
    EXPECT_EQ(lit_materials(test::with_black_triangle(table, distance, extent)),
              (std::vector{0, 0, 1}))
        << distance;
  const Scene near = test::with_black_triangle(table, 1, 0.5);
  EXPECT_EQ(lit_materials(near), (std::vector{0, 0, 1, 2}));
}

TEST(LitSurfaces, ASunIsNotButAPlainAndWhatIsOnItAre) {
  Scene sun = table;
  const int glow = test::add_material(sun, 0, 5);
  test::add_polygon(sun, {{-5e3, 5e3, 1e6}, {5e3, 5e3, 1e6}, {5e3, -5e3, 1e6}, {-5e3, -5e3, 1e6}},
                    glow);
  const std::vector<int> by_sun = lit_materials(sun);
  EXPECT_FALSE(std::count(by_sun.begin(), by_sun.end(), glow));
  EXPECT_EQ(std::count(by_sun.begin(), by_sun.end(), 0), 2);
  Scene plain = table;
  const int soil = test::add_material(plain, 0.5, 0);
  test::add_polygon(plain, {{-1e6, -1e6, -1}, {1e6, -1e6, -1}, {1e6, 1e6, -1}, {-1e6, 1e6, -1}},
                    soil);
  EXPECT_EQ(lit_materials(plain), (std::vector{0, 0, 1, soil}));
}

}  // namespace
}  // namespace halfshade
