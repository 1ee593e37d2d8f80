#pragma once

#include "io/files/little_endian.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

/// Small files in glTF 2.0.
namespace halfshade::test {

inline std::string base64(const std::string& bytes) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (unsigned k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

inline std::string triangle_buffer() {
  std::string buffer;
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) detail::put(buffer, x);
  for (const int i : {0, 1, 2}) detail::put(buffer, static_cast<std::uint16_t>(i));
  return buffer;
}

/// A triangle (0,0,0) (1,0,0) (0,1,0) in two nodes: "plain" and the mirrored and moved "twin".
inline nlohmann::json gltf_triangle() {
  const std::string buffer = triangle_buffer();
  nlohmann::json gltf = nlohmann::json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"name": "plain", "mesh": 0},
              {"name": "twin", "mesh": 0, "scale": [-2, 1, 1], "translation": [10, 20, 30]}],
    "meshes": [{"name": "shape", "primitives": [
      {"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "materials": [{"name": "glow", "doubleSided": true, "emissiveFactor": [1, 0.5, 0],
      "pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 0.75, 1]}}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                    {"buffer": 0, "byteOffset": 36, "byteLength": 6}]})");
  gltf["buffers"] = {{{"byteLength", buffer.size()},
                      {"uri", "data:application/octet-stream;base64," + base64(buffer)}}};
  return gltf;
}

/// The same file with its buffer in a binary chunk.
inline std::string as_glb(nlohmann::json gltf) {
  const auto chunk = [](const std::string& type, std::string content, char filler) {
    content.resize((content.size() + 3) / 4 * 4, filler);
    std::string bytes;
    detail::put(bytes, static_cast<std::uint32_t>(content.size()));
    return bytes + type + content;
  };
  const std::string buffer = triangle_buffer();
  gltf["buffers"] = {{{"byteLength", buffer.size()}}};
  const std::string chunks =
      chunk("JSON", gltf.dump(), ' ') + chunk(std::string("BIN\0", 4), buffer, '\0');
  std::string bytes = "glTF";
  detail::put(bytes, std::uint32_t{2});
  detail::put(bytes, static_cast<std::uint32_t>(12 + chunks.size()));
  return bytes + chunks;
}

}  // namespace halfshade::test
