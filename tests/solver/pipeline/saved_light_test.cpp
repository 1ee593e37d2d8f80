#include "solver/pipeline/saved_light.h"

#include "meshing/repair/repair.h"
#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace halfshade {
namespace {

/// Light of 1 on the two triangles of each wall of a unit cube.
SavedLight even_light(const SoundScene& scene) {
  SavedLight light;
  light.source = "file";
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    const int first = static_cast<int>(light.elements.points.size());
    for (const Vec2& q : surface.rings.front())
      light.elements.points.push_back(surface.frame.to_space(q));
    for (const int second : {1, 2}) {
      light.elements.corners.push_back({first, first + second, first + second + 1});
      light.elements.surface.push_back(static_cast<int>(s));
      light.rho.push_back(scene.materials[at(surface.material)].rho);
      light.exitance.push_back(scene.materials[at(surface.material)].exitance);
    }
  }
  light.irradiance = zero_field(std::vector<int>(light.elements.corners.size(), 0));
  for (int e = 0; e < light.irradiance.count(); ++e) light.irradiance.of(e).setOnes();
  return light;
}

// In a closed space all that arrives is the mean of what leaves: to rounding, for no ray gets lost.
TEST(SavedLight, IsReflectedOnce) {
  const SoundScene scene = make_sound(test::lit_cube({.3, .3, .3, .3, .3, .3}));
  const ReflectedLight light = reflection_of(scene, even_light(scene));
  for (const Surface& surface : scene.surfaces) {
    const Vec3 middle =
        surface.frame.to_space((surface.rings.front()[0] + surface.rings.front()[2]) / 2);
    EXPECT_LT((light.gather({middle, surface.frame.normal}, 100) - 0.3).abs().maxCoeff(), 1e-12);
  }
}

TEST(SavedLight, MustCoverTheScene) {
  const SoundScene scene = make_sound(test::lit_cube({.3, .3, .3, .3, .3, .3}));
  const auto refused = [&](const SavedLight& light, const char* why) {
    test::expect_error([&] { reflection_of(scene, light); }, ErrorCode::invalid_input,
                       {"no solution of the scene", why});
  };
  SavedLight light = even_light(scene);
  light.elements.surface[3] = 6;
  refused(light, "element 3 is of surface 6");
  light = even_light(scene);
  std::swap(light.elements.surface[0], light.elements.surface[11]);
  refused(light, "not in the plane");
  light = even_light(scene);
  std::swap(light.elements.corners[4][0], light.elements.corners[4][1]);
  refused(light, "surface 2 have an area");
  light = even_light(scene);
  light.rho[7] *= 1.01;
  refused(light, "element 7 is not of the material");
  light = even_light(scene);
  light.exitance[8] += 1;
  refused(light, "element 8 is not of the material");
  light = even_light(scene);
  light.elements.corners[5] = light.elements.corners[4];
  light.elements.corners[5][2] = light.elements.corners[5][1];
  refused(light, "surface 2 have an area");
}

}  // namespace
}  // namespace halfshade
