#pragma once

#include "tests/support/scene_maker.h"

#include <cmath>
#include <numbers>

namespace halfshade::test {

/// Two layers of slats, as wide as the gaps between them, that look down on a floor from under a
/// light; one layer is turned by 37 degrees. Penumbrae are many times as wide as the slats.
inline Scene turned_slats(int count) {
  SceneMaker maker;
  maker.down({-0.5, -0.5}, {0.5, 0.5}, 3.9, white_light);
  maker.up({-4, -4}, {4, 4}, 0);
  const double turn = 37 * std::numbers::pi / 180, cosine = std::cos(turn), sine = std::sin(turn);
  for (int k = 0; k < count; ++k) {
    const double from = -2 + 4. * k / count, to = from + 2. / count;
    maker.down({from, -2}, {to, 2}, 2);
    std::vector<Vec3> corners;
    for (const Vec2& p : {Vec2(from, 2), Vec2(to, 2), Vec2(to, -2), Vec2(from, -2)})
      corners.emplace_back(cosine * p.x() - sine * p.y(), sine * p.x() + cosine * p.y(), 2.2);
    maker.polygon(corners);
  }
  return maker.scene;
}

}  // namespace halfshade::test
