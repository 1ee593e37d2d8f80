#include "io/write/write_result.h"

#include "io/files/atomic_file.h"
#include "io/files/consistency.h"
#include "io/write/result_bytes.h"

namespace halfshade {

bool holds_straight(const std::filesystem::path& path, const ResultOptions& options) {
  return has_format(path, result_formats) && (options.linear || extension_of(path) != ".vtu");
}

void write_result(const SolveResult& result, const Provenance& provenance,
                  const std::filesystem::path& path, const ResultOptions& options) {
  require_format(path, result_formats);
  detail::require_consistent(result, "write_result");
  const std::string extension = extension_of(path);
  write_atomically(path, extension == ".ply" ? detail::ply_bytes(result, provenance)
                                             : detail::vtk_bytes(result, extension, options));
}

}  // namespace halfshade
