#pragma once

#include "io/write/write_result.h"

#include <filesystem>
#include <vector>

namespace halfshade {

/// Files of a series that write_series may make are named so.
bool is_of_series(const std::filesystem::path& name);

/// Writes the stages of progressive refinement into a folder, which is made if it is not there:
/// stage_000.vtu and so on, each a result as write_result writes it, and progressive.pvd, which
/// names them all with their number of shots as time, for ParaView to play. Field data also hold
/// shots and, per channel and in W, shot_power, unshot_power, absorbed_power, escaped_power. The
/// .pvd of an earlier series goes first and the new one comes last, so that it never names what is
/// not there; files left of a longer one are removed. Returns the .pvd. Throws Error(unwritable),
/// and Error(contract) without stages.
std::filesystem::path write_series(const SolveResult& result, const Provenance& provenance,
                                   const std::filesystem::path& folder);

}  // namespace halfshade
