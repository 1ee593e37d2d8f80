#include "tests/support/furniture.h"

#include <cmath>
#include <cstddef>

namespace halfshade::test {
namespace {

/// Four sides each, from the floor to a seat or table top that they touch.
void add_legs(SceneMaker& maker, const Vec2& low, const Vec2& high, double top) {
  constexpr double width = 0.06;
  for (const double x : {low.x(), high.x() - width})
    for (const double y : {low.y(), high.y() - width}) {
      const auto sides = box_faces({x, y, 0}, {x + width, y + width, top}, false);
      for (std::size_t f = 0; f < 4; ++f) maker.polygon(sides[f]);
    }
}

/// Somebody who sits on it looks along +x before it is turned.
void add_chair(SceneMaker& maker, const Vec2& place, double angle) {
  const std::size_t first = maker.scene.vertices.size();
  maker.box({-0.21, -0.2, 0.42}, {0.21, 0.2, 0.46});
  add_legs(maker, {-0.19, -0.18}, {0.19, 0.18}, 0.42);
  maker.standing_box({-0.21, -0.2, 0.46}, {-0.17, 0.2, 0.9});
  const Eigen::AngleAxisd turn(angle, Vec3::UnitZ());
  for (std::size_t v = first; v < maker.scene.vertices.size(); ++v)
    maker.scene.vertices[v] = turn * maker.scene.vertices[v] + Vec3(place.x(), place.y(), 0);
}

}  // namespace

SceneMaker table_and_chairs_maker() {
  SceneMaker maker;
  maker.down({-0.4, -0.3}, {0.4, 0.35}, 2.4, white_light);
  maker.box({-0.6, -0.4, 0.7}, {0.6, 0.4, 0.75});
  add_legs(maker, {-0.55, -0.35}, {0.55, 0.35}, 0.7);
  add_chair(maker, {-0.7, 0.05}, 0);
  add_chair(maker, {0.85, -0.3}, std::atan2(0.6, -0.8));
  return maker.up({-2.0371, -1.7371}, {1.9613, 1.8613}, 0);
}

}  // namespace halfshade::test
