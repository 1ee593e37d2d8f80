#include "tests/support/shadow_scenes.h"

#include <array>

namespace halfshade::test {

SoundScene bars(int count) {
  SceneMaker maker;
  maker.square_light(3);
  for (int i = 0; i < count; ++i) {
    const double c = 0.2 * i - 0.1 * (count - 1);
    maker.up({c - 0.05, -0.8}, {c + 0.05, 0.8}, 1.5).up({-0.8, c - 0.05}, {0.8, c + 0.05}, 1.6);
  }
  return maker.floor().sound();
}

SceneMaker skew_bars_maker() {
  SceneMaker maker;
  maker.square_light()
      .polygon({{-1.5, -1.5, 1}, {1.5, 1.5, 1}, {2.25, 0.75, 1}, {-0.75, -2.25, 1}})
      .polygon({{-1.4, 1.5, 0.6}, {1.6, -1.5, 0.9}, {0.85, -2.25, 0.9}, {-2.15, 0.75, 0.6}})
      .floor();
  return maker;
}

SoundScene one_triangle() {
  SceneMaker maker;
  maker.square_light().polygon({{.1, -.6, 1}, {.9, .2, 1}, {.2, .7, 1}});
  return maker.up({-2.5371, -2.3371}, {2.6613, 2.4613}, 0).sound();
}

SoundScene three_skew_slats() {
  SceneMaker maker;
  maker.square_light(2.5)
      .polygon({{-1, -0.9, 0.5}, {1.1, 0.8, 0.55}, {-0.9, -0.5, 0.52}})
      .polygon({{-1, 0.7, 0.9}, {1.1, -0.9, 0.95}, {1.0, -0.4, 0.97}})
      .polygon({{-0.1, -1, 1.3}, {0.15, 1.1, 1.35}, {0.5, 1, 1.33}});
  return maker.floor().sound();
}

SoundScene face_plane() {
  SceneMaker maker;
  maker.down({-1.5, -0.5}, {1, 0.8}, 3, white_light).box({0.9, -1, 0.5}, {1.7, 0.05, 1.5});
  return maker.up({-2.1371, -3.1371}, {4.1613, 2.0613}, 0).sound();
}

SoundScene boxes_on_floor() {
  SceneMaker maker;
  maker.square_light(2.2)
      .standing_box({-0.9, -0.8, 0}, {-0.3, -0.2, 0.7})
      .standing_box({0.2, 0.1, 0}, {0.7, 0.9, 0.35});
  // Turned, and with its bottom, which coincides with the floor.
  maker.turned_box({0.4, -0.9, 0}, {0.9, -0.5, 0.9}, 0.5);
  return maker.floor().sound();
}

SoundScene stacked_boxes() {
  SceneMaker maker;
  maker.square_light(2.5)
      .standing_box({-0.6, -0.5, 0}, {0.5, 0.6, 0.4})
      .standing_box({-0.5, -0.4, 0.4}, {0.2, 0.6, 0.8})  // flush with the lower one at y = .6
      .standing_box({-0.5, -0.1, 0.8}, {0, 0.3, 1.1});
  return maker.floor().sound();
}

SoundScene sphere_of_triangles() {
  SceneMaker maker;
  maker.square_light(2.2);
  // An octahedron each of whose faces is split into four: 32 triangles.
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3 s((octant & 1) ? -1 : 1, (octant & 2) ? -1 : 1, (octant & 4) ? -1 : 1);
    const bool mirrored = s.x() * s.y() * s.z() < 0;
    const auto place = [&](const Vec3& p) -> Vec3 {
      const Eigen::AngleAxisd turn(0.3, Vec3(1, 2, 0.5).normalized());
      return Vec3(0.1, -0.05, 0.9) + turn * (0.35 * p.normalized().cwiseProduct(s));
    };
    const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
    const std::array<std::array<Vec3, 3>, 4> parts = {
        {{x, x + y, x + z}, {x + y, y, y + z}, {x + z, y + z, z}, {x + y, y + z, x + z}}};
    for (const auto& [a, b, c] : parts)
      maker.polygon({place(a), place(mirrored ? c : b), place(mirrored ? b : c)});
  }
  return maker.floor().sound();
}

SoundScene open_box() {
  SceneMaker maker;
  maker.square_light(2.3);
  const auto faces = box_faces({-0.7, -0.5, 0.3}, {0.6, 0.7, 0.8}, false);
  for (std::size_t f = 0; f < 5; ++f) maker.polygon(faces[f], two_sided_grey);
  maker.standing_box({-0.2, -0.1, 0.3}, {0.05, 0.2, 1});
  return maker.floor().sound();
}

SoundScene window_in_a_sheet() {
  SceneMaker maker;
  maker.square_light();
  const std::array<Vec2, 4> outer = {{{-.9, -.8}, {.9, -.8}, {.9, .8}, {-.9, .8}}};
  const std::array<Vec2, 3> inner = {{{-.3, -.2}, {.35, -.3}, {.1, .4}}};
  const auto at = [](const Vec2& p) { return Vec3(p.x(), p.y(), 1 + 0.1 * p.x() - 0.2 * p.y()); };
  maker.polygon({at(outer[0]), at(outer[1]), at(inner[1]), at(inner[0])})
      .polygon({at(outer[1]), at(outer[2]), at(inner[2]), at(inner[1])})
      .polygon({at(outer[2]), at(outer[3]), at(inner[2])})
      .polygon({at(outer[3]), at(outer[0]), at(inner[0]), at(inner[2])});
  return maker.floor().sound();
}

SoundScene closed_room() {
  SceneMaker maker;
  for (const auto& face : box_faces({-1.6, -1.4, 0}, {1.5, 1.7, 2.2}, true)) maker.polygon(face);
  maker.down({-0.4, -0.5}, {0.5, 0.3}, 2.1, white_light);
  maker.standing_box({-0.9, -0.6, 0}, {-0.3, 0.2, 0.8})
      .polygon({{0.3, -0.3, 1.1}, {1, 0.1, 1.3}, {0.6, 0.7, 1.2}});
  return maker.sound();
}

}  // namespace halfshade::test
