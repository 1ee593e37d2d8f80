#include "io/write_result.h"

#include "io/atomic_file.h"
#include "io/detail/result_formats.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

using Format = std::string (*)(const SolveResult&, const Provenance&);

Format format_of(const std::filesystem::path& path) {
  const std::string extension = detail::lower_extension(path);
  if (extension == ".vtu") return detail::vtu_bytes;
  if (extension == ".vtp") return detail::vtp_bytes;
  if (extension == ".ply") return detail::ply_bytes;
  return nullptr;
}

}  // namespace

bool is_result_path(const std::filesystem::path& path) { return format_of(path) != nullptr; }

void write_result(const SolveResult& result, const Provenance& provenance,
                  const std::filesystem::path& path) {
  const Format format = format_of(path);
  if (format == nullptr)
    throw Error(ErrorCode::usage, path.string(),
                fmt::format("results are written as .vtu, .vtp or .ply, not as '{}'",
                            path.extension().string()));
  detail::require_consistent(result, "write_result");
  write_atomically(path, format(result, provenance));
}

namespace detail {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  return extension;
}

void require_consistent(const ElementTable& elements, const char* caller) {
  const std::size_t n = elements.corners.size();
  for (const std::size_t size :
       {elements.normal.size(), elements.area.size(), elements.receiver.size(),
        elements.face.size(), elements.group.size(), elements.material.size(),
        elements.level.size()})
    if (size != n)
      throw Error(ErrorCode::contract, caller,
                  fmt::format("an array of the {} elements has {} entries", n, size));
  const int points = static_cast<int>(elements.points.size());
  for (const auto& corners : elements.corners)
    for (const int p : corners)
      if (p < 0 || p >= points)
        throw Error(ErrorCode::contract, caller,
                    fmt::format("an element names point {} of {}", p, points));
}

void require_consistent(const SolveResult& result, const char* caller) {
  require_consistent(result.elements, caller);
  const auto n = static_cast<Eigen::Index>(result.elements.count());
  const Solution& s = result.solution;
  for (const ChannelArray* array :
       {&s.rho, &s.exitance, &s.radiosity, &s.irradiance, &s.direct_irradiance})
    if (array->rows() != n)
      throw Error(
          ErrorCode::contract, caller,
          fmt::format("the solution has {} rows for {} elements in an array", array->rows(), n));
}

}  // namespace detail
}  // namespace halfshade
