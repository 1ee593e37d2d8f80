#pragma once

#include "io/write/write_result.h"

#include <filesystem>
#include <vector>

namespace halfshade {

/// Writes what a program may want to know of a run as one JSON object: version, command_line, unit,
/// scene (counts), repairs, discontinuities (how they were found, kept and culled), mesh (elements,
/// points, min_angle and a histogram of the elements' minimum angles), stages, exchange, radiosity
/// (per channel), interrupted, outputs, and for each group its area, mean radiosity and irradiance,
/// emitted and absorbed power. Faces, materials and groups count from 0, as in the arrays of the
/// result files. Throws Error(unwritable).
void write_report(const SolveResult& result, const Provenance& provenance,
                  const std::vector<std::filesystem::path>& outputs,
                  const std::filesystem::path& path);

}  // namespace halfshade
