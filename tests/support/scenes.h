#pragma once

#include "meshing/core/scene.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

/// Scenes that tests build in memory. Every face gets a material of its own unless a test says
/// otherwise.
namespace halfshade::test {

/// Adds a material and returns its id.
inline int add_material(Scene& scene, double rho, double exitance) {
  Material material;
  material.name = "m";
  material.name += std::to_string(scene.materials.size());  // GCC 12 warns of "m" + …, wrongly
  material.rho = Rgb::Constant(rho);
  material.exitance = Rgb::Constant(exitance);
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

/// Adds a polygon with vertices of its own.
inline void add_polygon(Scene& scene, const std::vector<Vec3>& corners, int material) {
  if (scene.groups.empty()) scene.groups.emplace_back("all");
  Face face;
  for (const Vec3& p : corners) {
    face.vertices.push_back(static_cast<int>(scene.vertices.size()));
    scene.vertices.push_back(p);
  }
  face.material = material;
  scene.faces.push_back(face);
}

/// The six faces of a box in the order −x, +x, −y, +y, −z, +z, looking inwards or outwards.
inline std::array<std::vector<Vec3>, 6> box_faces(const Vec3& low, const Vec3& high, bool inwards) {
  const auto corner = [&](int i) {
    return Vec3((i & 1) ? high.x() : low.x(), (i & 2) ? high.y() : low.y(),
                (i & 4) ? high.z() : low.z());
  };
  // Counter-clockwise seen from outside.
  constexpr int outside[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  std::array<std::vector<Vec3>, 6> faces;
  for (int f = 0; f < 6; ++f)
    for (int k = 0; k < 4; ++k)
      faces[static_cast<std::size_t>(f)].push_back(corner(outside[f][inwards ? 3 - k : k]));
  return faces;
}

/// A closed box seen from inside, each face with a material of its own: rho and exitance by face.
inline Scene room(const Vec3& size, const std::array<std::pair<double, double>, 6>& rho_exitance) {
  Scene scene;
  const auto faces = box_faces(Vec3::Zero(), size, true);
  for (std::size_t f = 0; f < 6; ++f)
    add_polygon(scene, faces[f],
                add_material(scene, rho_exitance[f].first, rho_exitance[f].second));
  return scene;
}

/// A closed L-shaped room, 2 × 2 in plan less its quadrant x, y > 1, of height 1, with a box of
/// 0.3 × 0.3 × 0.5 hanging in it that blocks some of the view round the corner. 8 + 6 faces.
inline Scene l_room(bool with_obstruction) {
  Scene scene;
  const std::vector<Vec2> plan = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  std::vector<Vec3> floor, ceiling;
  for (const Vec2& p : plan) floor.emplace_back(p.x(), p.y(), 0);
  for (auto p = plan.rbegin(); p != plan.rend(); ++p) ceiling.emplace_back(p->x(), p->y(), 1);
  add_polygon(scene, floor, add_material(scene, 0.5, 0));
  add_polygon(scene, ceiling, add_material(scene, 0.5, 0));
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Vec2 a = plan[i], b = plan[(i + 1) % plan.size()];
    add_polygon(scene, {{b.x(), b.y(), 0}, {a.x(), a.y(), 0}, {a.x(), a.y(), 1}, {b.x(), b.y(), 1}},
                add_material(scene, 0.5, 0));
  }
  if (with_obstruction) {
    const auto box = box_faces({0.45, 0.45, 0.2}, {0.75, 0.75, 0.7}, false);
    for (const auto& face : box) add_polygon(scene, face, add_material(scene, 0.5, 0));
  }
  return scene;
}

/// A unit cube whose ceiling (face 5) emits; reflectances by face.
inline Scene lit_cube(const std::array<double, 6>& rho) {
  std::array<std::pair<double, double>, 6> faces;
  for (std::size_t f = 0; f < 6; ++f) faces[f] = {rho[f], f == 5 ? 1. : 0.};
  return room({1, 1, 1}, faces);
}

/// A unit box whose lid, a lamp that reflects as all the rest, is lifted by a gap.
inline Scene box_with_a_lifted_lid(double gap, double rho) {
  Scene scene;
  const int white = add_material(scene, rho, 0), lamp = add_material(scene, rho, 1);
  add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, white);
  add_polygon(scene, {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, white);
  add_polygon(scene, {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}}, white);
  add_polygon(scene, {{1, 1, 0}, {1, 1, 1}, {0, 1, 1}, {0, 1, 0}}, white);
  add_polygon(scene, {{0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {0, 0, 0}}, white);
  const double z = 1 + gap;
  add_polygon(scene, {{0, 0, z}, {0, 1, z}, {1, 1, z}, {1, 0, z}}, lamp);
  return scene;
}

/// A floor of 2 × 2 at z = 0, below it nothing; a light of 1 × 1 at z = 2; a table at z = 1.
inline Scene table_scene() {
  Scene scene;
  const int dark = add_material(scene, 0.5, 0), light = add_material(scene, 0, 1);
  add_polygon(scene, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, dark);
  add_polygon(scene, {{-.5, -.5, 2}, {-.5, .5, 2}, {.5, .5, 2}, {.5, -.5, 2}}, light);
  add_polygon(scene, {{-.25, -.25, 1}, {.25, -.25, 1}, {.25, .25, 1}, {-.25, .25, 1}}, dark);
  return scene;
}

}  // namespace halfshade::test
