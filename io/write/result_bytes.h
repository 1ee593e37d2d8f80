#pragma once

#include "io/write/write_result.h"

#include <string>
#include <string_view>

namespace halfshade::detail {

/// The bytes of the files that write_result writes.
std::string vtk_bytes(const SolveResult& result, std::string_view extension);
std::string ply_bytes(const SolveResult& result, const Provenance& provenance);

}  // namespace halfshade::detail
