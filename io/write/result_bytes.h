#pragma once

#include "io/write/write_result.h"

#include <string>
#include <string_view>

namespace halfshade::detail {

/// The bytes of the files that write_result writes.
std::string vtk_bytes(const SolveResult& result, std::string_view extension,
                      const ResultOptions& options);
/// Those of a stage of progressive refinement, as .vtu; `result` is as it was then.
std::string stage_bytes(const SolveResult& result, const RadiosityStage& stage);
std::string ply_bytes(const SolveResult& result, const Provenance& provenance);

}  // namespace halfshade::detail
