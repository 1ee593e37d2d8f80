#pragma once

#include "io/write/write_result.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace halfshade {

/// What every report says of the run.
struct RunInfo {
  Provenance provenance;
  std::vector<std::filesystem::path> outputs;
  std::string status = "done";        ///< or "interrupted", "not_accurate"
  double seconds = 0;                 ///< in all, up to the report
  std::size_t peak_memory_bytes = 0;  ///< of the program
};

}  // namespace halfshade
