#include "tests/support/light_scenes.h"

#include <array>
#include <utility>
#include <vector>

namespace halfshade::test {

SoundScene l_shaped_light() {
  SceneMaker maker;
  maker.polygon(
      {{-0.6, 0.6, 2}, {0, 0.6, 2}, {0, 0, 2}, {0.6, 0, 2}, {0.6, -0.6, 2}, {-0.6, -0.6, 2}},
      white_light);
  maker.polygon({{-0.3, -0.2, 1}, {0.4, -0.3, 1.1}, {0.1, 0.5, 0.9}});
  maker.turned_box({0.5, 0.4, 0.4}, {0.8, 0.7, 0.8}, 0.7);
  return maker.floor().sound();
}

SoundScene light_with_a_hole() {
  SceneMaker maker;
  const std::array<Vec2, 4> outer = {{{-.7, -.6}, {.7, -.6}, {.7, .6}, {-.7, .6}}};
  const std::array<Vec2, 4> inner = {{{-.2, -.3}, {.3, -.3}, {.3, .1}, {-.2, .1}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t n = (k + 1) % 4;
    maker.polygon({{inner[k].x(), inner[k].y(), 2},
                   {inner[n].x(), inner[n].y(), 2},
                   {outer[n].x(), outer[n].y(), 2},
                   {outer[k].x(), outer[k].y(), 2}},
                  white_light);
  }
  maker.polygon({{-0.5, -0.2, 1}, {0.3, -0.4, 1.2}, {0.2, 0.4, 0.9}});
  return maker.floor().sound();
}

SoundScene tilted_light() {
  SceneMaker maker;
  std::vector<Vec3> light;
  for (const auto& [x, y] : {std::pair(-.5, .5), {.4, .6}, {.5, -.5}, {-.4, -.6}})
    light.emplace_back(x, y, 1.8 - 0.3 * x + 0.2 * y);
  maker.polygon(light, white_light);
  maker.box({-0.3, -0.2, 0.6}, {0.1, 0.3, 0.9})
      .polygon({{0.3, -0.6, 0.5}, {0.9, -0.1, 0.8}, {0.5, 0.3, 0.4}});
  return maker.floor().sound();
}

SoundScene two_lights() {
  SceneMaker maker;
  maker.down({-1.1, -0.3}, {-0.5, 0.3}, 2, white_light)
      .down({0.5, -0.4}, {0.9, 0.2}, 2.3, bright_light)
      .box({-0.25, -0.35, 0.7}, {0.3, 0.25, 1.1})
      .polygon({{-0.9, -0.5, 1.2}, {-0.4, 0.1, 1.4}, {-0.8, 0.4, 1.3}});
  return maker.floor().sound();
}

SoundScene wall_light() {
  SceneMaker maker;
  maker.polygon({{-1.5, -0.6, 0.4}, {-1.5, 0.6, 0.4}, {-1.5, 0.6, 1.4}, {-1.5, -0.6, 1.4}},
                white_light);
  maker.standing_box({-0.8, -0.3, 0}, {-0.4, 0.35, 0.6})
      .polygon({{0.1, -0.7, 0.2}, {0.2, 0.3, 0.4}, {0.3, -0.1, 1.2}});
  return maker.up({-1.5, -2.0371}, {2.4613, 1.8613}, 0).sound();
}

SoundScene light_through_the_horizon() {
  SceneMaker maker;
  maker.polygon({{-1.5, -0.6, -0.3}, {-1.5, 0.6, -0.4}, {-1.5, 0.5, 1.1}, {-1.5, -0.5, 1}},
                white_light);
  maker.box({-0.8, -0.3, 0.2}, {-0.4, 0.35, 0.6})
      .polygon({{0.1, -0.7, -0.2}, {0.2, 0.3, 0.4}, {0.3, -0.1, 1.2}});
  return maker.up({-1.3371, -2.0371}, {2.4613, 1.8613}, 0).sound();
}

}  // namespace halfshade::test
