#include "solver/factors/factor_scene.h"

#include "meshing/core/error.h"
#include "meshing/repair/repair.h"
#include "solver/factors/unused_backs.h"

#include <fmt/format.h>

#include <map>

namespace halfshade {
namespace {

/// How far the box of the surroundings stands off, relative to the scene's diagonal. Far enough
/// that nothing is singular there, and near enough to keep digits.
constexpr double stand_off = 0.5;

/// Adds the box of the surroundings as six faces of a group and a material of their own.
void add_surroundings(Scene& scene) {
  Eigen::AlignedBox3d box;
  for (const Face& face : scene.faces)
    for (const int v : face.vertices) box.extend(scene.vertices[at(v)]);
  const Vec3 margin = Vec3::Constant(stand_off * box.diagonal().norm());
  const int first = static_cast<int>(scene.vertices.size());
  const Vec3 low = box.min() - margin, high = box.max() + margin;
  for (int k = 0; k < 8; ++k)
    scene.vertices.emplace_back((k & 1) ? high.x() : low.x(), (k & 2) ? high.y() : low.y(),
                                (k & 4) ? high.z() : low.z());
  scene.materials.emplace_back();
  scene.groups.emplace_back();
  // Counter-clockwise seen from inside.
  constexpr int inside[6][4] = {{2, 6, 4, 0}, {5, 7, 3, 1}, {4, 5, 1, 0},
                                {3, 7, 6, 2}, {1, 3, 2, 0}, {6, 7, 5, 4}};
  for (const auto& corners : inside) {
    Face face;
    for (const int k : corners) face.vertices.push_back(first + k);
    face.material = static_cast<int>(scene.materials.size()) - 1;
    face.group = static_cast<int>(scene.groups.size()) - 1;
    scene.faces.push_back(std::move(face));
  }
}

/// Gives every face a group of its own, so that the repair joins none.
void set_apart(Scene& scene) {
  scene.groups.assign(scene.faces.size(), {});
  for (std::size_t f = 0; f < scene.faces.size(); ++f) scene.faces[f].group = static_cast<int>(f);
}

void add_unused_backs(FactorScene& scene) {
  std::vector<bool> has_back;
  for (std::size_t s = 0; s < scene.row.size(); ++s)
    has_back.push_back(scene.row[s] >= 0 && !scene.sound.surfaces[s].back);
  for (Surface& back : uncovered_backs(scene.sound, has_back)) {
    scene.sound.surfaces.push_back(std::move(back));
    scene.row.push_back(unused_back);
  }
}

std::string name_of(const Scene& scene, FactorUnit unit, int id) {
  if (unit == FactorUnit::face) return fmt::format("face {}", id + 1);
  return unit == FactorUnit::group ? scene.groups[at(id)] : scene.materials[at(id)].name;
}

/// The row that a surface counts for.
FactorRow key_of(const Surface& surface, FactorUnit unit) {
  if (unit == FactorUnit::material) return {surface.material, surface.back};
  return {unit == FactorUnit::face ? surface.faces.front() : surface.group, surface.back};
}

}  // namespace

std::string row_name(const Scene& scene, FactorUnit unit, const FactorRow& row) {
  return name_of(scene, unit, row.id) + (row.is_back ? " back" : "");
}

FactorScene make_factor_scene(const Scene& scene, FactorUnit unit) {
  validate(scene);
  Scene surrounded = scene;
  add_surroundings(surrounded);
  if (unit == FactorUnit::face) set_apart(surrounded);
  FactorScene result;
  result.unit = scene.unit;
  result.sound = make_sound(surrounded);
  const std::vector<Surface>& surfaces = result.sound.surfaces;
  const auto is_around = [&](const Surface& surface) {
    return surface.faces.front() >= static_cast<int>(scene.faces.size());
  };
  std::map<FactorRow, int> rows;
  for (const Surface& surface : surfaces)
    if (!is_around(surface)) rows.emplace(key_of(surface, unit), 0);
  // make_sound does not say so, for the surroundings have areas.
  if (rows.empty())
    throw Error(ErrorCode::invalid_input, scene.source,
                fmt::format("none of its {} faces has an area", scene.faces.size()));
  for (auto& [key, row] : rows) {
    row = result.rows();
    result.keys.push_back(key);
    result.names.push_back(row_name(scene, unit, key));
    result.areas.push_back(0);
  }
  for (const Surface& surface : surfaces) {
    const int row = is_around(surface) ? surroundings : rows[key_of(surface, unit)];
    result.row.push_back(row);
    if (row >= 0) result.areas[at(row)] += area(surface);
  }
  add_unused_backs(result);
  return result;
}

}  // namespace halfshade
