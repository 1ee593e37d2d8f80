#include "io/write/write_result.h"

#include "io/files/atomic_file.h"
#include "io/files/consistency.h"
#include "io/files/extension.h"
#include "io/write/result_formats.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

namespace halfshade {
namespace {

using Format = std::string (*)(const SolveResult&, const Provenance&);

Format format_of(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
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
}  // namespace halfshade
