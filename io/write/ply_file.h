#pragma once

#include "io/write/write_result.h"

#include <string>

/// What all PLY files have in common.
namespace halfshade::detail {

inline constexpr const char *binary_ply = "binary_little_endian", *text_ply = "ascii";

/// The header up to the comments that every file has; `format` is one of the two above.
std::string ply_head(const char* format, const Provenance& provenance, const std::string& unit);

}  // namespace halfshade::detail
