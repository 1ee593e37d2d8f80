#include "io/files/little_endian.h"
#include "io/picture/tone_map.h"
#include "io/write/ply_file.h"
#include "io/write/result_bytes.h"
#include "meshing/core/error.h"
#include "solver/pipeline/linear_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace halfshade::detail {
namespace {

/// The nearest float; beyond the range of floats, its end.
float to_float(double value) {
  constexpr double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -largest, largest));
}

double exposure_for(const LinearResult& result) {
  std::vector<Rgb> values;
  std::vector<std::uint8_t> emits;
  for (int e = 0; e < result.elements.count(); ++e) {
    values.emplace_back(result.solution.radiosity.row(e));
    emits.push_back((result.solution.exitance.row(e) > 0).any());
  }
  return choose_exposure(values, result.elements.area, emits);
}

std::string header(const SolveResult& result, const ElementTable& elements,
                   const Provenance& provenance, double exposure) {
  return fmt::format(
      "{}"
      "comment exposure: {} (colours are the tone-mapped radiosity_r, _g, _b times this)\n"
      "{}"
      "element vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float radiosity_r\nproperty float radiosity_g\nproperty float radiosity_b\n"
      "element face {}\n"
      "property list uchar int vertex_indices\n"
      "end_header\n",
      ply_head(binary_ply, provenance, result.unit), exposure,
      result.interrupted ? "comment interrupted: the solution is not complete\n" : "",
      elements.points.size(), elements.count());
}

}  // namespace

std::string ply_bytes(const SolveResult& result, const Provenance& provenance) {
  const LinearResult linear = linear_result(result);
  const ElementTable& elements = linear.elements;
  const double exposure = exposure_for(linear);
  std::string bytes = header(result, elements, provenance, exposure);
  for (std::size_t i = 0; i < elements.points.size(); ++i) {
    const Vec3& p = elements.points[i];
    if (p.cwiseAbs().maxCoeff() > std::numeric_limits<float>::max())
      throw Error(ErrorCode::unwritable, "write_result",
                  fmt::format("point {} at ({}, {}, {}) is too far out for the single precision of "
                              "PLY; write .vtu instead",
                              i, p.x(), p.y(), p.z()));
    for (const double x : p) put(bytes, to_float(x));
    const Rgb value = linear.radiosity.row(static_cast<Eigen::Index>(i));
    for (const std::uint8_t c : encode_srgb(tone_map(value, exposure))) put(bytes, c);
    for (const double v : value) put(bytes, to_float(v));
  }
  for (const auto& corners : elements.corners) {
    put(bytes, std::uint8_t{3});
    for (const int p : corners) put(bytes, static_cast<std::int32_t>(p));
  }
  return bytes;
}

}  // namespace halfshade::detail
