#include "io/read/read_formats.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

namespace halfshade::reading {

int material_id(SceneDraft& draft, const std::string& name) {
  const auto [entry, is_new] =
      draft.material_ids.try_emplace(name, static_cast<int>(draft.scene.materials.size()));
  if (is_new) {
    draft.scene.materials.emplace_back().name = name;
    draft.origins.emplace_back().name = name;
  }
  return entry->second;
}

int group_id(SceneDraft& draft, const std::string& name) {
  const auto [entry, is_new] =
      draft.group_ids.try_emplace(name, static_cast<int>(draft.scene.groups.size()));
  if (is_new) draft.scene.groups.push_back(name);
  return entry->second;
}

void add_plain_face(SceneDraft& draft, const std::vector<long long>& corners, int line) {
  add_face(draft, corners, line, default_name);
}

void add_face(SceneDraft& draft, const std::vector<long long>& corners, int line,
              const std::string& group, const std::string& material) {
  Scene& scene = draft.scene;
  Face face;
  face.line = line;
  face.material = material_id(draft, material);
  face.group = group_id(draft, group);
  scene.faces.push_back(face);
  const auto reject = [&](const std::string& sentence) {
    throw Error(ErrorCode::invalid_input, scene.source,
                face_label(scene, static_cast<int>(scene.faces.size()) - 1) + sentence);
  };
  if (corners.size() < 3)
    reject(fmt::format(" has {} vertices; a polygon needs at least 3", corners.size()));
  std::vector<int>& vertices = scene.faces.back().vertices;
  vertices.reserve(corners.size());
  for (const long long v : corners) {
    if (v < 0 || v >= static_cast<long long>(scene.vertices.size()))
      reject(fmt::format(" names vertex {}, but vertices are numbered from 0 to {}", v,
                         static_cast<long long>(scene.vertices.size()) - 1));
    vertices.push_back(static_cast<int>(v));
  }
}

}  // namespace halfshade::reading
