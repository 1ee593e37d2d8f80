#pragma once

#include "meshing/repair/repair.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// Sound scenes built by hand, one surface a polygon, without going through make_sound.
namespace halfshade::test {

using Polygon = std::vector<Vec3>;

/// Adds a polygon with holes (outer ring counter-clockwise seen from its front, holes clockwise)
/// with a material of its own, and returns the surface's id.
inline int add_lit_surface(SoundScene& scene, const std::vector<Polygon>& rings,
                           double exitance = 0) {
  Surface surface;
  surface.frame = fit_plane(rings.front());
  for (const Polygon& polygon : rings) {
    surface.rings.emplace_back();
    for (const Vec3& p : polygon) surface.rings.back().push_back(surface.frame.to_plane(p));
  }
  surface.face_rings.push_back(surface.rings.front());
  surface.scale = scale_of(rings.front());
  const int id = static_cast<int>(scene.surfaces.size());
  surface.material = id;
  surface.plane = id;
  surface.faces = {id};
  Material material;
  material.name = std::to_string(id);
  material.exitance = Rgb::Constant(exitance);
  scene.materials.push_back(material);
  scene.surfaces.push_back(surface);
  return id;
}

inline int add_lit_surface(SoundScene& scene, const Polygon& polygon, double exitance = 0) {
  return add_lit_surface(scene, std::vector<Polygon>{polygon}, exitance);
}

inline void add_box(SoundScene& scene, const Vec3& low, const Vec3& high) {
  for (const auto& face : box_faces(low, high, false)) add_lit_surface(scene, face);
}

/// Sets the tolerance from the extent of what has been added.
inline void finish(SoundScene& scene) {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const Surface& surface : scene.surfaces)
    for (const Ring& ring : surface.rings)
      for (const Vec2& q : ring) {
        low = low.cwiseMin(surface.frame.to_space(q));
        high = high.cwiseMax(surface.frame.to_space(q));
      }
  scene.groups = {"all"};
  scene.diagonal = (high - low).norm();
}

/// Rectangle x0…x1 × y0…y1 at height z that faces down.
inline Polygon facing_down(double x0, double x1, double y0, double y1, double z) {
  return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

inline Polygon reversed(Polygon polygon) { return {polygon.rbegin(), polygon.rend()}; }

/// A convex polygon inscribed in a circle that looks in a random direction.
inline Polygon random_polygon(Random& random, const Vec3& centre, double radius, int corners) {
  const PlaneFrame frame = make_frame(centre, random.point(-1, 1));
  const double start = random(0, 6.28);
  Polygon polygon;
  for (int k = 0; k < corners; ++k) {
    const double angle = start + (k + random(0, 0.8)) * 6.283185307179586 / corners;
    polygon.push_back(frame.to_space(radius * Vec2(std::cos(angle), std::sin(angle))));
  }
  return polygon;
}

/// A square light [−.5, .5]² at height 2 (surface 0), a square occluder [−.375, .375]² at
/// height 1.
inline SoundScene square_over_square() {
  SoundScene scene;
  add_lit_surface(scene, facing_down(-.5, .5, -.5, .5, 2), 1);
  add_lit_surface(scene, facing_down(-.375, .375, -.375, .375, 1));
  finish(scene);
  return scene;
}

/// The triangles of an icosahedron, each split into four `levels` times, on a sphere.
inline std::vector<std::array<Vec3, 3>> icosphere(const Vec3& centre, double radius, int levels) {
  const double g = 0.5 * (1 + std::sqrt(5.));
  const std::vector<Vec3> v = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                               {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                               {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  constexpr std::array<std::array<std::size_t, 3>, 20> faces = {
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  std::vector<std::array<Vec3, 3>> triangles;
  for (const auto& f : faces)
    triangles.push_back({v[f[0]].normalized(), v[f[1]].normalized(), v[f[2]].normalized()});
  for (int level = 0; level < levels; ++level) {
    std::vector<std::array<Vec3, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const Vec3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  for (auto& triangle : triangles)
    for (Vec3& p : triangle) p = centre + radius * p;
  return triangles;
}

inline void add_sphere(SoundScene& scene, const Vec3& centre, double radius, int levels) {
  for (const auto& [a, b, c] : icosphere(centre, radius, levels))
    add_lit_surface(scene, Polygon{a, b, c});
}

}  // namespace halfshade::test
