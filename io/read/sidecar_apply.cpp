#include "io/read/materials_json.h"
#include "io/read/read_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace halfshade::reading {
namespace {

using nlohmann::json;
using std::filesystem::path;

std::string text_value(const json& value, const path& file, const std::string& key) {
  if (!value.is_string() || value.get_ref<const std::string&>().empty())
    fail(file, 0, fmt::format("{} must be a text that is not empty", key));
  return value.get<std::string>();
}

Camera read_camera(const json& entry, const path& file, std::size_t index) {
  const std::string key = fmt::format("camera {}", index + 1);
  require_object(entry, file, key);
  require_known_keys(entry, {"name", "position", "target", "direction", "up", "vertical_fov"}, file,
                     key);
  Camera camera;
  if (index > 0) camera.name = key;
  if (entry.contains("name")) camera.name = text_value(entry["name"], file, key_path(key, "name"));
  if (!entry.contains("position")) fail(file, 0, fmt::format("{} has no 'position'", key));
  camera.position = vector_value(entry["position"], file, key_path(key, "position"));
  if (entry.contains("target") == entry.contains("direction"))
    fail(file, 0, fmt::format("{} needs either a 'target' or a 'direction'", key));
  if (entry.contains("target"))
    camera.direction =
        vector_value(entry["target"], file, key_path(key, "target")) - camera.position;
  else
    camera.direction = vector_value(entry["direction"], file, key_path(key, "direction"));
  if (camera.direction.isZero(0)) fail(file, 0, fmt::format("{} looks into no direction", key));
  if (entry.contains("up")) camera.up = vector_value(entry["up"], file, key_path(key, "up"));
  if (entry.contains("vertical_fov")) {
    const json& fov = entry["vertical_fov"];
    camera.vertical_fov = fov.is_number() ? fov.get<double>() : 0;
    if (!(camera.vertical_fov > 0 && camera.vertical_fov < 180))
      fail(
          file, 0,
          fmt::format("{} must be a number of degrees in (0, 180)", key_path(key, "vertical_fov")));
  }
  return camera;
}

}  // namespace

void apply_sidecar(const path& file, SceneDraft& draft) {
  const json sidecar = read_json(file);
  require_object(sidecar, file, "");
  // Another run may have written it over the sidecar, with its materials: better no result than
  // one without them.
  if (sidecar.contains("command_line") && sidecar.contains("version"))
    fail(file, 0,
         "this is a report that halfshade has written (--json), not a sidecar with unit, cameras "
         "and materials; give it another name, or put the sidecar back");
  for (const auto& [name, value] : sidecar.items()) {
    if (name == "unit") {
      draft.scene.unit = text_value(value, file, in_quotes(name));
    } else if (name == "cameras") {
      if (!value.is_array()) fail(file, 0, "'cameras' must be a list [{…}, …]");
      draft.scene.cameras.clear();
      for (std::size_t i = 0; i < value.size(); ++i)
        draft.scene.cameras.push_back(read_camera(value[i], file, i));
    } else if (name == "materials") {
      apply_materials(value, file, "'materials'", draft);
    } else {
      // Another program's file of this name should not keep the scene from being read.
      draft.warnings.push_back(
          fmt::format("{}: the key {} is not used; known are 'cameras', 'materials' and 'unit'",
                      file.string(), in_quotes(name)));
    }
  }
}

}  // namespace halfshade::reading
