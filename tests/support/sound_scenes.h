#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/core/tolerance.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <cmath>

/// Sound scenes made without the repair, so that tests of what comes after it do not depend on it.
namespace halfshade::test {

/// Adds a polygon with holes as a surface. Rings lie in one plane; the first runs
/// counter-clockwise seen from the front, the holes clockwise.
inline void add_surface(SoundScene& scene, const std::vector<std::vector<Vec3>>& rings,
                        int material) {
  Surface surface;
  surface.frame = fit_plane(rings.front());
  for (const std::vector<Vec3>& ring : rings) {
    Ring& flat = surface.rings.emplace_back();
    for (const Vec3& p : ring) flat.push_back(surface.frame.to_plane(p));
  }
  surface.scale = scale_of(rings.front());
  surface.material = material;
  surface.faces = {static_cast<int>(scene.surfaces.size())};
  surface.face_rings = {surface.rings.front()};
  surface.plane = static_cast<int>(scene.surfaces.size());
  for (const Surface& other : scene.surfaces)
    if (std::abs(std::abs(other.frame.normal.dot(surface.frame.normal)) - 1) < 1e-13 &&
        std::abs(other.frame.height(surface.frame.origin)) < 1e-12 * scene.diagonal) {
      surface.plane = other.plane;
      break;
    }
  scene.surfaces.push_back(surface);
}

/// Materials 0 (does not emit) and 1 (E = 1), a nominal size, and nothing else.
inline SoundScene empty_sound_scene(double size) {
  SoundScene scene;
  scene.materials.resize(2);
  scene.materials[0].name = "dark";
  scene.materials[1].name = "light";
  scene.materials[1].exitance = Rgb::Ones();
  scene.groups = {"all"};
  scene.diagonal = size;
  return scene;
}

/// One surface a face.
inline SoundScene as_it_is(const Scene& scene) {
  SoundScene sound;
  sound.materials = scene.materials;
  sound.groups = scene.groups;
  sound.diagonal = diagonal(scene);
  for (int f = 0; f < static_cast<int>(scene.faces.size()); ++f)
    add_surface(sound, {face_corners(scene, f)}, scene.faces[static_cast<std::size_t>(f)].material);
  return sound;
}

/// S1: a light of 1 × 1 at z = 2 that looks down, an occluder of 0.75 × 0.75 at z = 1, a floor.
/// Surfaces 0, 1 and 2. data/s1.md derives what is known of it.
inline SoundScene s1() {
  SoundScene scene = empty_sound_scene(5.5);
  const auto square = [](double low, double high, double z) {
    return std::vector<Vec3>{{low, low, z}, {high, low, z}, {high, high, z}, {low, high, z}};
  };
  std::vector<Vec3> light = square(-0.5, 0.5, 2);
  std::reverse(light.begin(), light.end());
  add_surface(scene, {light}, 1);
  add_surface(scene, {square(-0.375, 0.375, 1)}, 0);
  add_surface(scene, {square(-1.9371, 1.8613, 0)}, 0);
  return scene;
}

/// A convex polygon of 3…7 corners on a circle.
inline std::vector<Vec3> random_polygon(Random& random, const Vec3& centre, const Vec3& normal,
                                        double radius) {
  const PlaneFrame frame = make_frame(centre, normal);
  const int corners = random.integer(3, 7);
  std::vector<Vec3> polygon;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * M_PI * (k + random(0.1, 0.9)) / corners;
    polygon.push_back(frame.to_space(radius * Vec2(std::cos(angle), std::sin(angle))));
  }
  return polygon;
}

/// The six outward faces of a turned box.
inline std::array<std::vector<Vec3>, 6> random_box(Random& random, const Vec3& centre,
                                                   double size) {
  const Vec3 half = random.in_box(Vec3::Constant(0.2 * size), Vec3::Constant(size));
  auto faces = box_faces(-half, half, false);
  const Eigen::AngleAxisd turn(random(0, 6), random.direction());
  for (auto& face : faces)
    for (Vec3& p : face) p = centre + turn * p;
  return faces;
}

}  // namespace halfshade::test
