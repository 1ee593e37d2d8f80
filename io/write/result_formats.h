#pragma once

#include "io/write/write_result.h"

#include <string>

namespace halfshade::detail {

/// The bytes of the files that write_result writes.
std::string vtu_bytes(const SolveResult& result, const Provenance& provenance);
std::string vtp_bytes(const SolveResult& result, const Provenance& provenance);
std::string ply_bytes(const SolveResult& result, const Provenance& provenance);

}  // namespace halfshade::detail
