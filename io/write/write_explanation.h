#pragma once

#include "io/write/run_info.h"
#include "solver/pipeline/explain.h"

#include <filesystem>

namespace halfshade {

/// Writes as one JSON object: version, command_line, status, seconds, peak_memory_bytes, unit,
/// scene (counts), repairs, warnings, channels, sources (surface, group, exitance, area), parts
/// (groups, area, closed, lit, swallowing), stages (name, left_out_because, force, amount, what,
/// seconds). Throws Error(unwritable).
void write_explanation(const Explanation& explanation, const RunInfo& run,
                       const std::filesystem::path& path);

}  // namespace halfshade
