#pragma once

#include "tests/support/scenes.h"
#include "tests/support/surfaces.h"

namespace halfshade::test {

/// Balls in a row in a room, of 20 · 4^levels facets each; walls are the first material, balls the
/// second.
inline Scene room_with_balls(int balls, int levels) {
  Scene scene;
  const int walls = add_material(scene, 0.5, 0), facets = add_material(scene, 0.5, 0);
  for (const auto& face : box_faces(Vec3::Zero(), {3. * balls, 4, 4}, true))
    add_polygon(scene, face, walls);
  for (int k = 0; k < balls; ++k)
    for (const auto& [a, b, c] : icosphere({1.5 + 3 * k, 2.1, 1.8}, 1, levels))
      add_polygon(scene, {a, b, c}, facets);
  return scene;
}

}  // namespace halfshade::test
