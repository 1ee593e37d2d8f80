#include "io/files/extension.h"
#include "io/read/read_formats.h"
#include "io/read/read_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>

namespace halfshade::reading {
namespace {

using nlohmann::json;

constexpr std::size_t header_size = 12, chunk_head_size = 8;

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// The JSON part of a .gltf or .glb file.
std::string_view json_part(std::string_view bytes) {
  if (!bytes.starts_with("glTF")) return bytes;
  // A header of three words, then the first chunk: its length, its type, its text.
  constexpr std::size_t text_at = header_size + chunk_head_size;
  if (bytes.size() < text_at) return {};
  return bytes.substr(text_at, little_endian(bytes, header_size));
}

}  // namespace

bool is_gltf(const std::filesystem::path& path) {
  const std::string ending = extension_of(path);
  return ending == ".gltf" || ending == ".glb";
}

void require_whole_glb(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path);
  if (!bytes.starts_with("glTF")) return;
  std::size_t at = header_size;
  do {
    if (bytes.size() - std::min(bytes.size(), at) < chunk_head_size)
      fail(path, 0, "the file ends within the head of a chunk");
    const std::size_t length = little_endian(bytes, at);
    at += chunk_head_size;
    if (length > bytes.size() - at)
      fail(path, 0,
           fmt::format("a chunk of {} bytes is announced, but {} are left; the file is cut short, "
                       "or the number is wrong",
                       length, bytes.size() - at));
    at += length;
  } while (at < bytes.size());
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
