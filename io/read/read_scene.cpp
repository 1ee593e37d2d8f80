#include "io/read/read_scene.h"

#include "io/files/extension.h"
#include "io/read/heat_values.h"
#include "io/read/materials_json.h"
#include "io/read/read_formats.h"
#include "io/read/read_text.h"
#include "meshing/core/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

using reading::SceneDraft;
using std::filesystem::path;

SceneDraft read_by_extension(const path& file) {
  const std::string extension = extension_of(file);
  if (extension == ".obj") return reading::read_obj(file);
  if (extension == ".ply") return reading::read_ply(file);
  if (extension == ".off") return reading::read_off(file);
  if (extension == ".stl") return reading::read_stl(file);
  if (extension == ".vs3") return reading::read_vs3(file);
  if (extension == ".msh") return reading::read_msh(file);
  for (const std::string_view known : {".gltf", ".glb", ".dae", ".3ds"})
    if (extension == known) return reading::read_with_assimp(file);
  throw Error(
      ErrorCode::usage, file.string(),
      fmt::format("{} of a scene; known are .obj, .ply, .off, .gltf, .glb, .stl, .dae, .3ds, "
                  ".vs3 and .msh",
                  extension.empty() ? "there is no extension that tells the format"
                                    : "'" + extension + "' is not a known format"));
}

void apply_json_files(const path& scene, const path& materials, SceneDraft& draft) {
  std::error_code ignored;
  const path sidecar = path(scene).replace_extension(".json");
  const bool same_file =
      !materials.empty() && std::filesystem::equivalent(sidecar, materials, ignored);
  if (!same_file && std::filesystem::exists(sidecar, ignored))
    reading::apply_sidecar(sidecar, draft);
  if (!materials.empty())
    reading::apply_materials(reading::read_json(materials), materials, "", draft);
}

/// Drops what no face uses, such as the rest of a material library, and keeps the order.
void drop_unused_materials(SceneDraft& draft) {
  Scene& scene = draft.scene;
  std::vector<int> new_id(scene.materials.size(), -1);
  for (const Face& face : scene.faces) new_id[static_cast<std::size_t>(face.material)] = 0;
  std::size_t kept = 0;
  for (std::size_t m = 0; m < new_id.size(); ++m) {
    if (new_id[m] < 0) continue;
    new_id[m] = static_cast<int>(kept);
    if (kept != m) {
      scene.materials[kept] = std::move(scene.materials[m]);
      draft.origins[kept] = std::move(draft.origins[m]);
    }
    ++kept;
  }
  scene.materials.resize(kept);
  draft.origins.resize(kept);
  for (Face& face : scene.faces) face.material = new_id[static_cast<std::size_t>(face.material)];
}

/// Finds what validate() would find, too, but knows the lines.
void check_materials(const SceneDraft& draft) {
  const auto reject = [&](const std::string& place, const std::string& sentence) {
    throw Error(ErrorCode::invalid_input, place.empty() ? draft.scene.source : place, sentence);
  };
  for (std::size_t m = 0; m < draft.origins.size(); ++m) {
    const Material& material = draft.scene.materials[m];
    const reading::MaterialOrigin& origin = draft.origins[m];
    if (!origin.undefined_place.empty())
      reject(origin.undefined_place,
             fmt::format("the material {} is not defined, neither by a material library (mtllib) "
                         "nor by a materials file",
                         reading::in_quotes(origin.name)));
    for (int c = 0; c < 3; ++c) {
      if (!(material.rho[c] >= 0 && material.rho[c] <= 1))
        reject(origin.rho_place,
               fmt::format("material {} has reflectance {} in channel {}; it must lie in [0, 1]",
                           reading::in_quotes(material.name), material.rho[c], c + 1));
      if (!(material.exitance[c] >= 0 && std::isfinite(material.exitance[c])))
        reject(origin.exitance_place,
               fmt::format("material {} has exitance {} in channel {}; it must be finite and not "
                           "negative",
                           reading::in_quotes(material.name), material.exitance[c], c + 1));
    }
  }
}

/// A library that is not there matters unless JSON files give every face its material.
void check_libraries(const SceneDraft& draft) {
  const bool covered =
      !draft.origins.empty() && std::all_of(draft.origins.begin(), draft.origins.end(),
                                            [](const auto& origin) { return origin.from_json; });
  if (!draft.missing.empty() && !covered)
    throw Error(ErrorCode::invalid_input, draft.missing.front().place,
                draft.missing.front().sentence);
}

/// Says what is taken where the files say nothing.
std::vector<std::string> guesses_in(const SceneDraft& draft) {
  std::vector<std::string> guesses;
  for (std::size_t m = 0; m < draft.origins.size(); ++m) {
    if (draft.origins[m].name != reading::default_name || !draft.origins[m].rho_place.empty() ||
        draft.origins[m].heat.is_adiabatic)
      continue;
    const auto& faces = draft.scene.faces;
    const auto count = std::count_if(faces.begin(), faces.end(), [&](const Face& face) {
      return face.material == static_cast<int>(m);
    });
    guesses.push_back(
        fmt::format("{}: {} of {} faces have no material; their reflectance is taken as {}",
                    draft.scene.source, count, faces.size(), draft.scene.materials[m].rho[0]));
  }
  return guesses;
}

std::vector<std::string> empty_groups(const SceneDraft& draft) {
  std::vector<std::string> empty;
  for (const std::string& name : draft.named_groups)
    if (!draft.group_ids.contains(name)) empty.push_back(name);
  return empty;
}

}  // namespace

SceneFile read_scene(const path& file, const path& materials, const LampOptions& lamps) {
  SceneDraft draft = read_by_extension(file);
  if (draft.scene.faces.empty()) {
    check_libraries(draft);
    throw Error(ErrorCode::invalid_input, file.string(), "there are no faces in the file");
  }
  apply_json_files(file, materials, draft);
  drop_unused_materials(draft);
  check_libraries(draft);
  Heat heat = reading::apply_heat(draft);
  check_materials(draft);
  const std::vector<reading::PaintedEmitter> painted = reading::lay_pictures(draft);
  LampPictures pictures = reading::cut_painted_lights(draft, painted, lamps);
  drop_unused_materials(draft);
  for (const reading::MissingFile& missing : draft.missing)
    draft.warnings.push_back(missing.place + ": " + missing.sentence);
  std::vector<std::string> guesses = guesses_in(draft), empty = empty_groups(draft);
  validate(draft.scene);
  return {std::move(draft.scene), std::move(draft.warnings), std::move(guesses),
          std::move(draft.files), std::move(empty),          std::move(heat),
          std::move(pictures)};
}

}  // namespace halfshade
