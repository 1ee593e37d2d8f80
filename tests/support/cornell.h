#pragma once

#include "tests/support/scenes.h"

namespace halfshade::test {

/// The published Cornell box in mm (Cornell University Program of Computer Graphics, 1998), with
/// the light in the plane of the ceiling, which has no hole for it. Every quadrilateral has a
/// material of its own kind: 0 white, 1 red, 2 green, 3 light. Faces: floor, light, ceiling, back
/// wall, green wall, red wall, 5 of the short block, 5 of the tall block.
inline Scene cornell_box() {
  Scene scene;
  for (const double rho : {0.75, 0.6, 0.4, 0.0}) add_material(scene, rho, rho == 0.0 ? 10 : 0);
  add_polygon(scene, {{552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}}, 0);
  add_polygon(scene, {{343, 548.8, 227}, {343, 548.8, 332}, {213, 548.8, 332}, {213, 548.8, 227}},
              3);
  add_polygon(scene, {{556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0}}, 0);
  add_polygon(scene, {{549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}}, 0);
  add_polygon(scene, {{0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}}, 2);
  add_polygon(scene, {{552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}}, 1);
  add_polygon(scene, {{130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}}, 0);
  add_polygon(scene, {{290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}}, 0);
  add_polygon(scene, {{130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}}, 0);
  add_polygon(scene, {{82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}}, 0);
  add_polygon(scene, {{240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}}, 0);
  add_polygon(scene, {{423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}}, 0);
  add_polygon(scene, {{423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}}, 0);
  add_polygon(scene, {{472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}}, 0);
  add_polygon(scene, {{314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}}, 0);
  add_polygon(scene, {{265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}}, 0);
  return scene;
}

}  // namespace halfshade::test
