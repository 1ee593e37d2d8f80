#pragma once

#include "meshing/repair/repair.h"
#include "tests/support/sound_scenes.h"

#include <string>
#include <utility>
#include <vector>

/// Scenes with every kind of shadow line. Lengths of a few units, floors in z = 0. Their limits are
/// uneven, so that no line is where a regular mesh has one.
namespace halfshade::test {

struct NamedScene {
  std::string name;
  SoundScene scene;
};

/// Materials of all scenes here.
enum : int { grey = 0, white_light = 1, bright_light = 2, two_sided_grey = 3 };

/// Collects polygons.
class SceneMaker {
 public:
  SceneMaker() {
    add_material(scene, 0.5, 0);
    add_material(scene, 0, 1);
    add_material(scene, 0, 3);
    add_material(scene, 0.5, 0);
    scene.materials[two_sided_grey].two_sided = true;
  }

  SceneMaker& polygon(const std::vector<Vec3>& corners, int material = grey) {
    add_polygon(scene, corners, material);
    return *this;
  }
  /// x0…x1 × y0…y1 at height z, looking up or down.
  SceneMaker& up(const Vec2& low, const Vec2& high, double z, int material = grey) {
    return polygon({{low.x(), low.y(), z},
                    {high.x(), low.y(), z},
                    {high.x(), high.y(), z},
                    {low.x(), high.y(), z}},
                   material);
  }
  SceneMaker& down(const Vec2& low, const Vec2& high, double z, int material = grey) {
    return polygon({{low.x(), high.y(), z},
                    {high.x(), high.y(), z},
                    {high.x(), low.y(), z},
                    {low.x(), low.y(), z}},
                   material);
  }
  SceneMaker& box(const Vec3& low, const Vec3& high) {
    for (const auto& face : box_faces(low, high, false)) polygon(face);
    return *this;
  }
  /// The same without its bottom, to stand on something.
  SceneMaker& standing_box(const Vec3& low, const Vec3& high) {
    const auto faces = box_faces(low, high, false);
    for (const std::size_t f : {0, 1, 2, 3, 5}) polygon(faces[f]);
    return *this;
  }
  /// Turned about the vertical through its middle.
  SceneMaker& turned_box(const Vec3& low, const Vec3& high, double angle) {
    const Eigen::AngleAxisd turn(angle, Vec3::UnitZ());
    const Vec3 middle = 0.5 * (low + high);
    for (auto face : box_faces(low, high, false)) {
      for (Vec3& p : face) p = middle + turn * (p - middle);
      polygon(face);
    }
    return *this;
  }
  SceneMaker& tetrahedron(const std::array<Vec3, 4>& p) {
    const bool right = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) > 0;
    const Vec3 &a = p[0], &b = right ? p[1] : p[2], &c = right ? p[2] : p[1], &d = p[3];
    return polygon({a, c, b}).polygon({a, b, d}).polygon({b, c, d}).polygon({c, a, d});
  }
  SceneMaker& square_light(double z = 2, int material = white_light) {
    return down({-0.5, -0.5}, {0.5, 0.5}, z, material);
  }
  SceneMaker& floor() { return up({-1.9371, -2.0371}, {1.9613, 1.8613}, 0); }
  SceneMaker& move(const Vec3& by) {
    for (Vec3& p : scene.vertices) p += by;
    return *this;
  }
  SoundScene sound() const { return make_sound(scene); }

  Scene scene;
};

/// Places for balls that do not touch each other, between floor and light.
class FreePlaces {
 public:
  explicit FreePlaces(std::uint64_t seed) : random(seed) {}
  Vec3 next(double radius) {
    for (;;) {
      const Vec3 centre = random.in_box({-1, -1, 0.1 + radius}, {1, 1, 1.75 - radius});
      bool is_free = true;
      for (const auto& [c, r] : taken_) is_free = is_free && (c - centre).norm() > r + radius;
      if (!is_free) continue;
      taken_.emplace_back(centre, radius);
      return centre;
    }
  }
  Random random;

 private:
  std::vector<std::pair<Vec3, double>> taken_;
};

inline SoundScene random_polygons(std::uint64_t seed, int count) {
  FreePlaces places(seed);
  SceneMaker maker;
  maker.square_light().floor();
  for (int i = 0; i < count; ++i) {
    const double radius = places.random(0.15, 0.4);
    const Vec3 centre = places.next(radius), normal = places.random.direction();
    maker.polygon(random_polygon(places.random, centre, normal, radius));
  }
  return maker.sound();
}

inline SoundScene random_boxes(std::uint64_t seed, int count) {
  FreePlaces places(seed);
  SceneMaker maker;
  maker.square_light().floor();
  for (int i = 0; i < count; ++i) {
    const double size = places.random(0.1, 0.22);
    const Vec3 centre = places.next(1.75 * size);
    for (const auto& face : random_box(places.random, centre, size)) maker.polygon(face);
  }
  return maker.sound();
}

inline SoundScene random_tetrahedra(std::uint64_t seed, int count) {
  FreePlaces places(seed);
  SceneMaker maker;
  maker.square_light().floor();
  for (int i = 0; i < count; ++i) {
    const double radius = places.random(0.15, 0.4);
    const Vec3 centre = places.next(radius);
    for (;;) {
      std::array<Vec3, 4> p;
      for (Vec3& q : p) q = centre + radius * places.random.direction();
      const double volume = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) / 6;
      if (std::abs(volume) < 0.05 * radius * radius * radius) continue;
      maker.tetrahedron(p);
      break;
    }
  }
  return maker.sound();
}

/// Bars of bars.md, `count` each way.
inline SoundScene bars(int count) {
  SceneMaker maker;
  maker.square_light(3);
  for (int i = 0; i < count; ++i) {
    const double c = 0.2 * i - 0.1 * (count - 1);
    maker.up({c - 0.05, -0.8}, {c + 0.05, 0.8}, 1.5).up({-0.8, c - 0.05}, {0.8, c + 0.05}, 1.6);
  }
  return maker.floor().sound();
}

/// Those of skew_bars.md: an umbra that ends in a conic.
inline SceneMaker skew_bars_maker() {
  SceneMaker maker;
  maker.square_light()
      .polygon({{-1.5, -1.5, 1}, {1.5, 1.5, 1}, {2.25, 0.75, 1}, {-0.75, -2.25, 1}})
      .polygon({{-1.4, 1.5, 0.6}, {1.6, -1.5, 0.9}, {0.85, -2.25, 0.9}, {-2.15, 0.75, 0.6}})
      .floor();
  return maker;
}

/// A triangle below the light whose corner (.9, .2, 1) and edge to (.2, .7, 1) make vertex–edge
/// lines on the floor through (2.3, .4) and (.74, .3).
inline SoundScene one_triangle() {
  SceneMaker maker;
  maker.square_light().polygon({{.1, -.6, 1}, {.9, .2, 1}, {.2, .7, 1}});
  return maker.up({-2.5371, -2.3371}, {2.6613, 2.4613}, 0).sound();
}

/// Three narrow triangles, each with an edge of three skew lines that meet others through the
/// light's inside: lines of three edges of which none is the light's.
inline SoundScene three_skew_slats() {
  SceneMaker maker;
  maker.square_light(2.5)
      .polygon({{-1, -0.9, 0.5}, {1.1, 0.8, 0.55}, {-0.9, -0.5, 0.52}})
      .polygon({{-1, 0.7, 0.9}, {1.1, -0.9, 0.95}, {1.0, -0.4, 0.97}})
      .polygon({{-0.1, -1, 1.3}, {0.15, 1.1, 1.35}, {0.5, 1, 1.33}});
  return maker.floor().sound();
}

/// The plane y = .05 of the box's side cuts the light: the silhouette seen from the floor goes
/// over from one edge to another on the line through (2.5, .05).
inline SoundScene face_plane() {
  SceneMaker maker;
  maker.down({-1.5, -0.5}, {1, 0.8}, 3, white_light).box({0.9, -1, 0.5}, {1.7, 0.05, 1.5});
  return maker.up({-2.1371, -3.1371}, {4.1613, 2.0613}, 0).sound();
}

/// Four sides each, from the floor to a seat or table top that they touch.
inline void add_legs(SceneMaker& maker, const Vec2& low, const Vec2& high, double top) {
  constexpr double width = 0.06;
  for (const double x : {low.x(), high.x() - width})
    for (const double y : {low.y(), high.y() - width}) {
      const auto sides = box_faces({x, y, 0}, {x + width, y + width, top}, false);
      for (std::size_t f = 0; f < 4; ++f) maker.polygon(sides[f]);
    }
}

/// Somebody who sits on it looks along +x before it is turned.
inline void add_chair(SceneMaker& maker, const Vec2& place, double angle) {
  const std::size_t first = maker.scene.vertices.size();
  maker.box({-0.21, -0.2, 0.42}, {0.21, 0.2, 0.46});
  add_legs(maker, {-0.19, -0.18}, {0.19, 0.18}, 0.42);
  maker.standing_box({-0.21, -0.2, 0.46}, {-0.17, 0.2, 0.9});
  const Eigen::AngleAxisd turn(angle, Vec3::UnitZ());
  for (std::size_t v = first; v < maker.scene.vertices.size(); ++v)
    maker.scene.vertices[v] = turn * maker.scene.vertices[v] + Vec3(place.x(), place.y(), 0);
}

/// A table and two chairs under a ceiling light, of boxes that touch along faces.
inline SceneMaker table_and_chairs_maker() {
  SceneMaker maker;
  maker.down({-0.4, -0.3}, {0.4, 0.35}, 2.4, white_light);
  maker.box({-0.6, -0.4, 0.7}, {0.6, 0.4, 0.75});
  add_legs(maker, {-0.55, -0.35}, {0.55, 0.35}, 0.7);
  add_chair(maker, {-0.7, 0.05}, 0);
  add_chair(maker, {0.85, -0.3}, std::atan2(0.6, -0.8));
  return maker.up({-2.0371, -1.7371}, {1.9613, 1.8613}, 0);
}

inline SoundScene boxes_on_floor() {
  SceneMaker maker;
  maker.square_light(2.2)
      .standing_box({-0.9, -0.8, 0}, {-0.3, -0.2, 0.7})
      .standing_box({0.2, 0.1, 0}, {0.7, 0.9, 0.35});
  // Turned, and with its bottom, which coincides with the floor.
  maker.turned_box({0.4, -0.9, 0}, {0.9, -0.5, 0.9}, 0.5);
  return maker.floor().sound();
}

inline SoundScene stacked_boxes() {
  SceneMaker maker;
  maker.square_light(2.5)
      .standing_box({-0.6, -0.5, 0}, {0.5, 0.6, 0.4})
      .standing_box({-0.5, -0.4, 0.4}, {0.2, 0.6, 0.8})  // flush with the lower one at y = .6
      .standing_box({-0.5, -0.1, 0.8}, {0, 0.3, 1.1});
  return maker.floor().sound();
}

inline SoundScene l_shaped_light() {
  SceneMaker maker;
  maker.polygon(
      {{-0.6, 0.6, 2}, {0, 0.6, 2}, {0, 0, 2}, {0.6, 0, 2}, {0.6, -0.6, 2}, {-0.6, -0.6, 2}},
      white_light);
  maker.polygon({{-0.3, -0.2, 1}, {0.4, -0.3, 1.1}, {0.1, 0.5, 0.9}});
  maker.turned_box({0.5, 0.4, 0.4}, {0.8, 0.7, 0.8}, 0.7);
  return maker.floor().sound();
}

/// Of four trapezoids that become one polygon.
inline SoundScene light_with_a_hole() {
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

inline SoundScene tilted_light() {
  SceneMaker maker;
  std::vector<Vec3> light;
  for (const auto& [x, y] : {std::pair(-.5, .5), {.4, .6}, {.5, -.5}, {-.4, -.6}})
    light.emplace_back(x, y, 1.8 - 0.3 * x + 0.2 * y);
  maker.polygon(light, white_light);
  maker.box({-0.3, -0.2, 0.6}, {0.1, 0.3, 0.9})
      .polygon({{0.3, -0.6, 0.5}, {0.9, -0.1, 0.8}, {0.5, 0.3, 0.4}});
  return maker.floor().sound();
}

inline SoundScene two_lights() {
  SceneMaker maker;
  maker.down({-1.1, -0.3}, {-0.5, 0.3}, 2, white_light)
      .down({0.5, -0.4}, {0.9, 0.2}, 2.3, bright_light)
      .box({-0.25, -0.35, 0.7}, {0.3, 0.25, 1.1})
      .polygon({{-0.9, -0.5, 1.2}, {-0.4, 0.1, 1.4}, {-0.8, 0.4, 1.3}});
  return maker.floor().sound();
}

/// A window in a wall that stands on the floor, and things before it.
inline SoundScene wall_light() {
  SceneMaker maker;
  maker.polygon({{-1.5, -0.6, 0.4}, {-1.5, 0.6, 0.4}, {-1.5, 0.6, 1.4}, {-1.5, -0.6, 1.4}},
                white_light);
  maker.standing_box({-0.8, -0.3, 0}, {-0.4, 0.35, 0.6})
      .polygon({{0.1, -0.7, 0.2}, {0.2, 0.3, 0.4}, {0.3, -0.1, 1.2}});
  return maker.up({-1.5, -2.0371}, {2.4613, 1.8613}, 0).sound();
}

/// A light whose plane the floor crosses and that goes on below it: the floor is its horizon.
inline SoundScene light_through_the_horizon() {
  SceneMaker maker;
  maker.polygon({{-1.5, -0.6, -0.3}, {-1.5, 0.6, -0.4}, {-1.5, 0.5, 1.1}, {-1.5, -0.5, 1}},
                white_light);
  maker.box({-0.8, -0.3, 0.2}, {-0.4, 0.35, 0.6})
      .polygon({{0.1, -0.7, -0.2}, {0.2, 0.3, 0.4}, {0.3, -0.1, 1.2}});
  return maker.up({-1.3371, -2.0371}, {2.4613, 1.8613}, 0).sound();
}

inline SoundScene sphere_of_triangles() {
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

/// A box without a lid, of two-sided sheets, with a post inside.
inline SoundScene open_box() {
  SceneMaker maker;
  maker.square_light(2.3);
  const auto faces = box_faces({-0.7, -0.5, 0.3}, {0.6, 0.7, 0.8}, false);
  for (std::size_t f = 0; f < 5; ++f) maker.polygon(faces[f], two_sided_grey);
  maker.standing_box({-0.2, -0.1, 0.3}, {0.05, 0.2, 1});
  return maker.floor().sound();
}

/// A wall with a window in front of a light.
inline SoundScene window_in_a_sheet() {
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

/// A closed room: every wall is a surface, and the plane of the light cuts none.
inline SoundScene closed_room() {
  SceneMaker maker;
  for (const auto& face : box_faces({-1.6, -1.4, 0}, {1.5, 1.7, 2.2}, true)) maker.polygon(face);
  maker.down({-0.4, -0.5}, {0.5, 0.3}, 2.1, white_light);
  maker.standing_box({-0.9, -0.6, 0}, {-0.3, 0.2, 0.8})
      .polygon({{0.3, -0.3, 1.1}, {1, 0.1, 1.3}, {0.6, 0.7, 1.2}});
  return maker.sound();
}

/// In general position, or nearly.
inline std::vector<NamedScene> discontinuity_scenes() {
  std::vector<NamedScene> all = {{"s1", s1()},
                                 {"one_triangle", one_triangle()},
                                 {"skew_bars", skew_bars_maker().sound()},
                                 {"three_skew_slats", three_skew_slats()},
                                 {"face_plane", face_plane()},
                                 {"bars", bars(4)},
                                 {"table_and_chairs", table_and_chairs_maker().sound()},
                                 {"boxes_on_floor", boxes_on_floor()},
                                 {"stacked_boxes", stacked_boxes()},
                                 {"l_shaped_light", l_shaped_light()},
                                 {"light_with_a_hole", light_with_a_hole()},
                                 {"tilted_light", tilted_light()},
                                 {"two_lights", two_lights()},
                                 {"wall_light", wall_light()},
                                 {"light_through_the_horizon", light_through_the_horizon()},
                                 {"sphere_of_triangles", sphere_of_triangles()},
                                 {"open_box", open_box()},
                                 {"window_in_a_sheet", window_in_a_sheet()},
                                 {"closed_room", closed_room()}};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    all.push_back({"polygons_" + std::to_string(seed), random_polygons(seed, 5)});
    all.push_back({"boxes_" + std::to_string(seed), random_boxes(seed, 4)});
    all.push_back({"tetrahedra_" + std::to_string(seed), random_tetrahedra(seed, 5)});
  }
  return all;
}

}  // namespace halfshade::test
