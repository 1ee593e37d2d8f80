#include "io/read/materials_json.h"
#include "io/read/read_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace halfshade::reading {
namespace {

using nlohmann::json;
using std::filesystem::path;

struct Override {
  std::optional<Rgb> rho, exitance;
  std::optional<bool> two_sided;
};

/// One number or three; each at least 0 and at most `most`.
Rgb channels(const json& value, double most, const path& file, const std::string& key) {
  Rgb result = Rgb::Constant(NAN);
  if (value.is_number()) {
    result = Rgb::Constant(value.get<double>());
  } else if (value.is_array() && value.size() == 3) {
    for (int c = 0; c < 3; ++c)
      if (const json& number = value[static_cast<std::size_t>(c)]; number.is_number())
        result[c] = number.get<double>();
  }
  if (!result.allFinite())
    fail(file, 0, fmt::format("{} must be a number or three numbers [r, g, b]", key));
  for (const double channel : result)
    if (!(channel >= 0 && channel <= most))
      fail(file, 0,
           std::isfinite(most) ? fmt::format("{} is {}; it must lie in [0, {}]", key, channel, most)
                               : fmt::format("{} is {}; it must not be negative", key, channel));
  return result;
}

Override read_override(const json& entry, const path& file, const std::string& key) {
  require_object(entry, file, key);
  require_known_keys(entry, {"reflectance", "exitance", "two_sided"}, file, key);
  Override result;
  if (const auto at = entry.find("reflectance"); at != entry.end())
    result.rho = channels(*at, 1, file, key_path(key, "reflectance"));
  if (const auto at = entry.find("exitance"); at != entry.end())
    result.exitance = channels(*at, HUGE_VAL, file, key_path(key, "exitance"));
  if (const auto at = entry.find("two_sided"); at != entry.end()) {
    if (!at->is_boolean())
      fail(file, 0, fmt::format("{} must be true or false", key_path(key, "two_sided")));
    result.two_sided = at->get<bool>();
  }
  return result;
}

void apply(const Override& change, const path& file, Material& material, MaterialOrigin& origin) {
  if (change.rho) material.rho = *change.rho;
  if (change.rho) origin.rho_place = file.string();
  if (change.exitance) material.exitance = *change.exitance;
  if (change.exitance) origin.exitance_place = file.string();
  if (change.two_sided) material.two_sided = *change.two_sided;
  origin.undefined_place.clear();
  origin.from_json = true;
}

/// Applies to every material of this name, of which a group may have made variants.
bool apply_by_material(const Override& change, const path& file, const std::string& name,
                       SceneDraft& draft) {
  bool any = false;
  for (std::size_t m = 0; m < draft.origins.size(); ++m)
    if (draft.origins[m].name == name) {
      apply(change, file, draft.scene.materials[m], draft.origins[m]);
      any = true;
    }
  return any;
}

/// Gives each of the groups' faces a changed copy of its material, one per group and material.
void apply_by_group(const std::map<int, Override>& changes, const path& file, SceneDraft& draft) {
  Scene& scene = draft.scene;
  std::map<std::pair<int, int>, int> copies;
  for (Face& face : scene.faces) {
    const auto change = changes.find(face.group);
    if (change == changes.end()) continue;
    const auto [copy, is_new] =
        copies.try_emplace({face.group, face.material}, static_cast<int>(scene.materials.size()));
    if (is_new) {
      const auto original = static_cast<std::size_t>(face.material);
      Material material = scene.materials[original];
      MaterialOrigin origin = draft.origins[original];
      const std::string& group = scene.groups[static_cast<std::size_t>(face.group)];
      material.name =
          origin.name == default_name ? group : fmt::format("{} ({})", origin.name, group);
      apply(change->second, file, material, origin);
      scene.materials.push_back(std::move(material));
      draft.origins.push_back(std::move(origin));
    }
    face.material = copy->second;
  }
}

/// True if there is a material of the group's name with other faces than the group's.
bool means_two_things(const std::string& name, int group, const SceneDraft& draft) {
  bool any = false, differs = false;
  for (const Face& face : draft.scene.faces) {
    const bool of_material = draft.origins[static_cast<std::size_t>(face.material)].name == name;
    any |= of_material;
    differs |= of_material != (face.group == group);
  }
  return any && differs;
}

std::vector<std::string> material_names(const SceneDraft& draft) {
  std::vector<std::string> names;
  for (const MaterialOrigin& origin : draft.origins)
    if (std::find(names.begin(), names.end(), origin.name) == names.end())
      names.push_back(origin.name);
  return names;
}

}  // namespace

void apply_materials(const json& materials, const path& file, const std::string& key,
                     SceneDraft& draft) {
  require_object(materials, file, key);
  std::map<int, Override> by_group;
  for (const auto& [name, entry] : materials.items()) {
    const Override change = read_override(entry, file, key_path(key, name));
    if (const auto group = draft.group_ids.find(name); group != draft.group_ids.end()) {
      if (means_two_things(name, group->second, draft))
        draft.warnings.push_back(
            fmt::format("{}: {} names a group and a material that do not have the same faces; it "
                        "is applied to the group",
                        file.string(), key_path(key, name)));
      by_group[group->second] = change;
    } else if (!apply_by_material(change, file, name, draft)) {
      fail(file, 0,
           fmt::format("{} is neither a group nor a material of {}; its groups are {}, its "
                       "materials {}",
                       key_path(key, name), draft.scene.source, listed(draft.scene.groups),
                       listed(material_names(draft))));
    }
  }
  apply_by_group(by_group, file, draft);
}

}  // namespace halfshade::reading
