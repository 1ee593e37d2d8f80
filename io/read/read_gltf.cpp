#include "io/files/extension.h"
#include "io/read/read_formats.h"
#include "io/read/read_text.h"

#include <nlohmann/json.hpp>

#include <cstdint>

namespace halfshade::reading {
namespace {

using nlohmann::json;

/// The JSON part of a .gltf or .glb file.
std::string_view json_part(std::string_view bytes) {
  if (!bytes.starts_with("glTF")) return bytes;
  // A header of three words, then the first chunk: its length, its type, its text.
  constexpr std::size_t length_at = 12, text_at = 20;
  if (bytes.size() < text_at) return {};
  std::uint32_t length = 0;
  for (std::size_t i = 4; i-- > 0;)
    length = length << 8U | static_cast<unsigned char>(bytes[length_at + i]);
  return bytes.substr(text_at, length);
}

}  // namespace

bool is_gltf(const std::filesystem::path& path) {
  const std::string ending = extension_of(path);
  return ending == ".gltf" || ending == ".glb";
}

std::map<std::string, double> gltf_emissive_strengths(const std::filesystem::path& path) {
  std::map<std::string, double> strengths;
  const std::string bytes = read_bytes(path);
  const json gltf = json::parse(json_part(bytes), nullptr, false);
  if (!gltf.is_object() || !gltf.contains("materials")) return strengths;
  const json::json_pointer at("/extensions/KHR_materials_emissive_strength/emissiveStrength");
  for (const json& material : gltf["materials"]) {
    if (!material.is_object() || !material.contains(at) || !material[at].is_number()) continue;
    const auto name = material.find("name");
    if (name != material.end() && name->is_string())
      strengths[name->get<std::string>()] = material[at].get<double>();
  }
  return strengths;
}

}  // namespace halfshade::reading
