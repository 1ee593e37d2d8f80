#pragma once

#include "tests/support/discontinuity_scenes.h"

#include <algorithm>
#include <numeric>
#include <string_view>

/// Rooms of 8 × 8 × 3 with one light of 1 × 1 below the ceiling and about as many polygons as asked
/// for, of three kinds.
namespace halfshade::test {

constexpr double room_width = 8, room_height = 3;

inline int polygon_count(const SceneMaker& maker) {
  return static_cast<int>(maker.scene.faces.size());
}

inline void add_room(SceneMaker& maker) {
  for (const auto& face : box_faces(Vec3::Zero(), {room_width, room_width, room_height}, true))
    maker.polygon(face);
  maker.down({3.4173, 3.6219}, {4.4173, 4.6219}, 2.95, white_light);
}

inline void add_table(SceneMaker& maker, Random& random, const Vec2& centre, double cell,
                      double height) {
  const Vec2 half(cell * random(0.25, 0.37), cell * random(0.25, 0.37));
  const double top = height * random(0.6, 0.8), thick = 0.04 * height, leg = 0.05 * cell;
  maker.box({centre.x() - half.x(), centre.y() - half.y(), top - thick},
            {centre.x() + half.x(), centre.y() + half.y(), top});
  for (const double x : {centre.x() - half.x() + 0.3 * leg, centre.x() + half.x() - 1.3 * leg})
    for (const double y : {centre.y() - half.y() + 0.3 * leg, centre.y() + half.y() - 1.3 * leg}) {
      const auto sides = box_faces({x, y, 0}, {x + leg, y + leg, top - thick}, false);
      for (std::size_t f = 0; f < 4; ++f) maker.polygon(sides[f]);
    }
  const Vec2 at = centre + Vec2(random(-0.5, 0.5) * half.x(), random(-0.5, 0.5) * half.y());
  const Vec2 size(cell * random(0.06, 0.12), cell * random(0.06, 0.12));
  maker.standing_box({at.x() - size.x(), at.y() - size.y(), top},
                     {at.x() + size.x(), at.y() + size.y(), top + height * random(0.1, 0.4)});
}

inline void add_cupboard(SceneMaker& maker, Random& random, const Vec2& centre, double cell,
                         double height) {
  const Vec2 half(cell * random(0.12, 0.35), cell * random(0.12, 0.35));
  const double top = height * random(0.25, 1.1);
  maker.standing_box({centre.x() - half.x(), centre.y() - half.y(), 0},
                     {centre.x() + half.x(), centre.y() + half.y(), top});
  if (random(0, 1) > 0.5) return;
  const Vec2 size(half.x() * random(0.2, 0.6), half.y() * random(0.2, 0.6));
  maker.standing_box(
      {centre.x() - size.x(), centre.y() - size.y(), top},
      {centre.x() + size.x(), centre.y() + size.y(), top + height * random(0.1, 0.3)});
}

/// A: tables and cupboards, parallel to the walls, that stand on the floor and carry things.
inline Scene furnished_room(int polygons) {
  Random random(7);
  SceneMaker maker;
  add_room(maker);
  const int cells = std::max(1, (polygons - 7) / 12);
  const int side = static_cast<int>(std::ceil(std::sqrt(cells)));
  const double cell = room_width / side, height = std::min(1., std::sqrt(cell / 0.9));
  std::vector<int> order(static_cast<std::size_t>(side * side));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i-- > 1;)
    std::swap(order[i], order[static_cast<std::size_t>(random.integer(0, static_cast<int>(i)))]);
  for (const int place : order) {
    if (polygon_count(maker) >= polygons) break;
    const Vec2 centre((place % side + random(0.4, 0.6)) * cell,
                      (place / side + random(0.4, 0.6)) * cell);
    if (random(0, 1) < 0.3)
      add_table(maker, random, centre, cell, height);
    else
      add_cupboard(maker, random, centre, cell, height);
  }
  return maker.scene;
}

inline void add_octahedron(SceneMaker& maker, const Vec3& centre, const Eigen::Matrix3d& axes) {
  for (const double x : {-1., 1.})
    for (const double y : {-1., 1.})
      for (const double z : {-1., 1.}) {
        const Vec3 a = centre + x * axes.col(0), b = centre + y * axes.col(1);
        const Vec3 c = centre + z * axes.col(2);
        x* y* z > 0 ? maker.polygon({a, b, c}) : maker.polygon({a, c, b});
      }
}

/// B: turned boxes, octahedra and tetrahedra that float in the room and touch nothing.
inline Scene cluttered_room(int polygons) {
  Random random(7);
  SceneMaker maker;
  add_room(maker);
  const double largest = std::min(0.6, 1.03 / std::cbrt(std::max(1, (polygons - 7) / 6)));
  std::vector<std::pair<Vec3, double>> taken;
  while (polygon_count(maker) < polygons) {
    const double r = largest * random(0.5, 1);
    const Vec3 centre = random.in_box({r, r, r + 0.02}, {room_width - r, room_width - r, 2.6 - r});
    if (std::any_of(taken.begin(), taken.end(), [&](const auto& ball) {
          return (ball.first - centre).norm() < ball.second + r;
        }))
      continue;
    taken.emplace_back(centre, r);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(random(0, 6), random.direction()).toRotationMatrix();
    const Vec3 half = r * random.in_box(Vec3::Constant(0.3), Vec3::Ones());
    const int kind = random.integer(0, 2);
    if (kind == 0) {
      for (auto face : box_faces(-half / std::sqrt(3.), half / std::sqrt(3.), false)) {
        for (Vec3& p : face) p = centre + turn * p;
        maker.polygon(face);
      }
    } else if (kind == 1) {
      add_octahedron(maker, centre, turn * half.asDiagonal().toDenseMatrix());
    } else {
      maker.tetrahedron({centre + turn * Vec3(r, 0, 0), centre + turn * Vec3(-0.4 * r, 0.8 * r, 0),
                         centre + turn * Vec3(-0.3 * r, -0.7 * r, 0.4 * r),
                         centre + turn * Vec3(-0.2 * r, 0, -0.9 * r)});
    }
  }
  return maker.scene;
}

/// K: three layers of slats that cross each other under the light, from which almost every three
/// edges make a line.
inline Scene slatted_room(int polygons) {
  Random random(7);
  SceneMaker maker;
  add_room(maker);
  const int slats = std::max(1, (polygons - 7) / 6);
  constexpr double width = 0.012, thickness = 0.00024;
  for (int i = 0; i < slats; ++i) {
    const double angle = random(-0.15, 0.15) + (i % 3) * M_PI / 3;
    const Vec3 half(random(1.5, 3), width, thickness);
    const Vec3 centre(random(3.2, 4.8), random(3.2, 4.8), 1 + 0.5 * (i % 3) + 0.3 * i / slats);
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(angle, Vec3::UnitZ()) *
                                  Eigen::AngleAxisd(random(-0.004, 0.004), Vec3::UnitY()))
                                     .toRotationMatrix();
    for (auto face : box_faces(-half, half, false)) {
      for (Vec3& p : face) p = centre + turn * p;
      maker.polygon(face);
    }
  }
  return maker.scene;
}

/// 'A', 'B' or 'K'.
inline Scene family(char kind, int polygons) {
  return kind == 'A'   ? furnished_room(polygons)
         : kind == 'B' ? cluttered_room(polygons)
                       : slatted_room(polygons);
}

}  // namespace halfshade::test
