#include "io/read/heat_values.h"
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
  MaterialEntry entry;
  std::optional<bool> two_sided;
};

/// One number, or as many as there are bands, or three; each at least 0 and at most `most`.
Eigen::ArrayXd channels(const json& value, double most, const std::vector<Band>& bands,
                        const path& file, const std::string& key) {
  const std::size_t count = bands.empty() ? most_channels : bands.size();
  Eigen::ArrayXd result = Eigen::ArrayXd::Constant(static_cast<Eigen::Index>(count), NAN);
  if (value.is_number()) {
    result.setConstant(value.get<double>());
  } else if (value.is_array() && value.size() == count) {
    for (std::size_t c = 0; c < count; ++c)
      if (value[c].is_number()) result[static_cast<Eigen::Index>(c)] = value[c].get<double>();
  }
  if (!result.isFinite().all())
    fail(file, 0,
         bands.empty() ? fmt::format("{} must be a number or three numbers [r, g, b]", key)
                       : fmt::format("{} must be a number or a list of one for each of the {} "
                                     "bands",
                                     key, count));
  for (const double channel : result)
    if (!(channel >= 0 && channel <= most))
      fail(file, 0,
           std::isfinite(most) ? fmt::format("{} is {}; it must lie in [0, {}]", key, channel, most)
                               : fmt::format("{} is {}; it must not be negative", key, channel));
  return result;
}

double single_number(const json& value, const path& file, const std::string& key) {
  if (!value.is_number()) fail(file, 0, fmt::format("{} must be a number", key));
  return value.get<double>();
}

Override read_override(const json& object, const std::vector<Band>& bands, const path& file,
                       const std::string& key) {
  require_object(object, file, key);
  require_known_keys(
      object, {"reflectance", "exitance", "emissivity", "temperature", "net_flux", "two_sided"},
      file, key);
  Override result;
  MaterialEntry& entry = result.entry;
  for (const auto& [name, value] : object.items()) {
    const std::string place = key_path(key, name);
    if (name == "reflectance") entry.rho = channels(value, 1, bands, file, place);
    if (name == "exitance") entry.exitance = channels(value, HUGE_VAL, bands, file, place);
    if (name == "emissivity") entry.emissivity = channels(value, 1, bands, file, place);
    if (name == "temperature") entry.temperature = single_number(value, file, place);
    if (name == "net_flux") entry.net_flux = single_number(value, file, place);
    if (name != "two_sided") continue;
    if (!value.is_boolean()) fail(file, 0, fmt::format("{} must be true or false", place));
    result.two_sided = value.get<bool>();
  }
  require_consistent(entry, file, 0, key);
  return result;
}

void apply(const Override& change, bool by_band, const path& file, Material& material,
           MaterialOrigin& origin) {
  const MaterialEntry& entry = change.entry;
  apply_entry(entry, file.string(), material, origin);
  if (by_band && entry.rho) origin.rho_by_band = *entry.rho;
  if (by_band && entry.emissivity) origin.rho_by_band = 1 - *entry.emissivity;
  if (by_band && entry.exitance) origin.exitance_by_band = *entry.exitance;
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
      apply(change, !draft.bands.empty(), file, draft.scene.materials[m], draft.origins[m]);
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
      apply(change->second, !draft.bands.empty(), file, material, origin);
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
  const auto bands = materials.find("bands");
  const bool has_bands = bands != materials.end() && bands->is_array();
  if (has_bands) take_bands(*bands, file, key_path(key, "bands"), draft);
  for (const auto& [name, entry] : materials.items()) {
    if (has_bands && name == "bands") continue;
    const Override change = read_override(entry, draft.bands, file, key_path(key, name));
    if (const auto group = draft.group_ids.find(name); group != draft.group_ids.end()) {
      if (means_two_things(name, group->second, draft))
        draft.warnings.push_back(
            fmt::format("{}: {} names a group and a material that do not have the same faces; it "
                        "is applied to the group",
                        file.string(), key_path(key, name)));
      by_group[group->second] = change;
    } else if (!apply_by_material(change, file, name, draft)) {
      if (draft.named_groups.count(name) > 0)
        fail(file, 0,
             fmt::format("{} is a group of {} that has no faces", key_path(key, name),
                         draft.scene.source));
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
