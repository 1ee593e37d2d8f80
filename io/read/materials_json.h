#pragma once

#include "io/read/read_formats.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// What JSON files add to a scene.
namespace halfshade::reading {

/// The value in a file; comments are allowed. Throws Error(invalid_input) with file and line, and
/// names a key that an object has twice with values that differ.
nlohmann::json read_json(const std::filesystem::path& path);

/// Applies an object {name: {"reflectance", "exitance", "emissivity", "temperature", "net_flux",
/// "two_sided"}}, and {"bands": […]} beside them. A name is a group's or else a material's; of the
/// two, the group's entry wins on its faces, which get a material of their own. `key` says where
/// the object stands in the file ("materials"), empty for the whole file. Throws
/// Error(invalid_input) naming file and key.
void apply_materials(const nlohmann::json& materials, const std::filesystem::path& path,
                     const std::string& key, SceneDraft& draft);

/// Makes the bands of a list [name or {"name", "wavelengths_um": [shortest, longest]}, …] the
/// scene's channels. Throws Error(invalid_input) naming file and key.
void take_bands(const nlohmann::json& value, const std::filesystem::path& path,
                const std::string& key, SceneDraft& draft);

/// Applies a scene's sidecar: unit, cameras, materials. Warns of keys it does not know.
void apply_sidecar(const std::filesystem::path& path, SceneDraft& draft);

/// "a: b: c", how messages name a key within others.
std::string key_path(const std::string& outer, const std::string& key);

/// Fails unless `value` is an object.
void require_object(const nlohmann::json& value, const std::filesystem::path& path,
                    const std::string& key);

/// Fails if an object has other keys than these.
void require_known_keys(const nlohmann::json& object, const std::vector<std::string>& known,
                        const std::filesystem::path& path, const std::string& key);

/// Three finite numbers.
Vec3 vector_value(const nlohmann::json& value, const std::filesystem::path& path,
                  const std::string& key);

}  // namespace halfshade::reading
