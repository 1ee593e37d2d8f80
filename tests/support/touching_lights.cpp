#include "tests/support/touching_lights.h"

#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace halfshade::test {
namespace {

using Polygon = std::vector<Vec3>;

constexpr int black = 0, shining = 1;

Scene floor_alone() {
  Scene scene;
  add_material(scene, 0, 0);
  add_material(scene, 0, 1);
  add_polygon(scene, {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, black);
  return scene;
}

Eigen::Matrix3d turn(Random& random) {
  const Vec3 a = random.direction(), b = a.cross(random.direction()).normalized();
  Eigen::Matrix3d rows;
  rows << a.transpose(), b.transpose(), a.cross(b).transpose();
  return rows;
}

void add_box(Scene& scene, const Vec3& low, const Vec3& high, const Eigen::Matrix3d& turned) {
  const Vec3 middle = (low + high) / 2;
  for (Polygon face : box_faces(low, high, false)) {
    for (Vec3& p : face) p = middle + turned * (p - middle);
    add_polygon(scene, face, black);
  }
}

void add_tetrahedron(Scene& scene, const Vec3& centre, double radius, Random& random) {
  std::array<Vec3, 4> p;
  double volume = 0;
  do {
    for (Vec3& q : p) q = centre + radius * random.direction();
    volume = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
  } while (std::abs(volume) < 0.3 * radius * radius * radius);
  if (volume < 0) std::swap(p[0], p[1]);
  for (const auto& [a, b, c] :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{0, 3, 2}})
    add_polygon(scene, {p[at(a)], p[at(b)], p[at(c)]}, black);
}

/// None, or from a tenth to a ten thousandth.
double gap(Random& random) { return random.below(3) < 2 ? 0 : std::pow(10, -random(1, 4)); }

/// A sheet from a to b on the floor, of that height, that leans to the side by `lean`; it looks
/// to the left of a → b.
Polygon sheet(const Vec2& a, const Vec2& b, double bottom, double height, double lean) {
  const Vec2 along = (b - a).normalized(), left(-along.y(), along.x());
  const Vec2 over = lean * left;
  const Vec3 low_a(a.x(), a.y(), bottom), low_b(b.x(), b.y(), bottom);
  const Vec3 up(over.x(), over.y(), height);
  return {low_b, low_a, low_a + up, low_b + up};
}

struct Lamp {
  Vec2 middle, along, left;
  double width, bottom, height;
};

Lamp add_lamp(Scene& scene, Random& random) {
  const double angle = random(0, 2 * M_PI);
  Lamp lamp{{random(-1, 1), random(-1, 1)},
            {std::cos(angle), std::sin(angle)},
            {-std::sin(angle), std::cos(angle)},
            random(0.3, 1.2),
            gap(random),
            random(0.3, 1.2)};
  const Vec2 a = lamp.middle - lamp.width / 2 * lamp.along,
             b = lamp.middle + lamp.width / 2 * lamp.along;
  const double lean = random.below(2) == 0 ? 0 : random(-0.4, 0.4);
  Polygon corners = sheet(a, b, lamp.bottom, lamp.height, lean);
  switch (random.below(3)) {
    case 0:
      break;
    case 1:  // stands on a corner: a triangle
      corners = {corners[0] + (corners[1] - corners[0]) * 0.4, corners[2], corners[3]};
      break;
    default:  // on an edge, narrower above
      corners[2] += 0.3 * (corners[3] - corners[2]);
  }
  add_polygon(scene, corners, shining);
  return lamp;
}

void add_thing(Scene& scene, const Lamp& lamp, Random& random) {
  const double reach = random(0.05, 0.6);
  switch (random.below(4)) {
    case 0: {  // a sheet that stands before the light
      const Vec2 a = lamp.middle + reach * lamp.left + random(-0.4, 0.1) * lamp.along;
      const Vec2 b = a + random(0.2, 0.6) * lamp.along + random(-0.2, 0.2) * lamp.left;
      const double height = random(0.1, 0.5);
      add_polygon(scene, sheet(a, b, gap(random), height, 0), black);
      add_polygon(scene, sheet(b, a, gap(random), height, 0), black);
      break;
    }
    case 1: {  // a box on the floor
      const Vec2 low = lamp.middle + (0.3 + reach) * lamp.left - Vec2(0.1, 0.1);
      const double bottom = gap(random);
      add_box(scene, {low.x(), low.y(), bottom},
              {low.x() + random(0.1, 0.4), low.y() + random(0.1, 0.4), bottom + random(0.1, 0.5)},
              Eigen::Matrix3d::Identity());
      break;
    }
    case 2: {  // a shelf that touches the light, or nearly
      const Vec2 a = lamp.middle + gap(random) * lamp.left - 0.3 * lamp.width * lamp.along;
      const Vec2 b = a + random(0.2, 0.9) * lamp.width * lamp.along;
      const Vec2 out = reach * lamp.left;
      const double z = lamp.bottom + random(0.1, 0.9) * lamp.height;
      const Polygon top = {{a.x(), a.y(), z},
                           {b.x(), b.y(), z},
                           {b.x() + out.x(), b.y() + out.y(), z},
                           {a.x() + out.x(), a.y() + out.y(), z}};
      add_polygon(scene, top, black);
      add_polygon(scene, {top.rbegin(), top.rend()}, black);
      break;
    }
    default: {  // a tetrahedron in the air
      const double radius = random(0.1, 0.25);
      const Vec2 p = lamp.middle + (0.3 + reach) * lamp.left;
      add_tetrahedron(scene, {p.x(), p.y(), radius + gap(random)}, radius, random);
    }
  }
}

}  // namespace

Scene convex_occluders(std::uint64_t seed) {
  Random random(seed);
  Scene scene = floor_alone();
  add_polygon(scene, {{-.5, .5, 2}, {.5, .5, 2}, {.5, -.5, 2}, {-.5, -.5, 2}}, shining);
  const int count = random.integer(1, 3);
  for (int k = 0; k < count; ++k) {
    // Each in a third of its own, so that they do not meet.
    const Vec3 centre(1.1 * (k - (count - 1) / 2.) + random(-0.1, 0.1), random(-0.7, 0.7),
                      random(0.6, 1.4));
    const double size = random(0.15, 0.42);
    const Vec3 half = Vec3(random(0.4, 1), random(0.4, 1), random(0.4, 1)) * size / std::sqrt(3);
    switch (random.below(3)) {
      case 0:
        add_box(scene, centre - half, centre + half, turn(random));
        break;
      case 1:
        add_tetrahedron(scene, centre, size, random);
        break;
      default: {
        const Eigen::Matrix3d turned = turn(random);
        Polygon ring;
        const int corners = random.integer(3, 6);
        for (int i = 0; i < corners; ++i) {
          const double angle = 2 * M_PI * (i + random(-0.3, 0.3)) / corners;
          ring.push_back(centre + size * turned * Vec3(std::cos(angle), std::sin(angle), 0));
        }
        add_polygon(scene, ring, black);
        add_polygon(scene, {ring.rbegin(), ring.rend()}, black);
      }
    }
  }
  return scene;
}

Scene touching_light(std::uint64_t seed) {
  Random random(seed);
  Scene scene = floor_alone();
  const Lamp lamp = add_lamp(scene, random);
  for (int k = random.integer(0, 2); k > 0; --k) add_thing(scene, lamp, random);
  return scene;
}

}  // namespace halfshade::test
