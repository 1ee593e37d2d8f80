#pragma once

#include "tests/support/discontinuity_scenes.h"

namespace halfshade::test {

/// A floor with boxes on it under a grid of lamps of two strengths, `side` each way, 2 apart: most
/// of them give a place little, and much of that is hidden.
inline Scene lamp_hall(int side) {
  constexpr double spacing = 2, lamp_height = 3.1, half = 0.2;
  Random random(11);
  SceneMaker maker;
  const double width = spacing * side;
  maker.up({0, 0}, {width, width}, 0);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const Vec2 low(spacing * i, spacing * j);
      const Vec2 lamp = low + Vec2(random(0.5, 1.5), random(0.5, 1.5));
      maker.down(lamp - Vec2::Constant(half), lamp + Vec2::Constant(half), lamp_height,
                 (i + j) % 3 == 0 ? bright_light : white_light);
      const Vec2 corner = low + Vec2(random(0.1, 0.9), random(0.1, 0.9));
      maker.standing_box(
          {corner.x(), corner.y(), 0},
          {corner.x() + random(0.3, 0.9), corner.y() + random(0.3, 0.9), random(0.5, 2.8)});
    }
  return maker.scene;
}

}  // namespace halfshade::test
