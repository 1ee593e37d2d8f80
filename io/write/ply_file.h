#pragma once

#include "io/files/little_endian.h"
#include "io/write/write_result.h"

#include <array>
#include <string>

/// What all PLY files have in common.
namespace halfshade::detail {

/// The header up to the comments that every file has.
std::string ply_head(const Provenance& provenance, const std::string& unit);

/// Appends the value of "property list uchar int vertex_indices".
void put_triangle(std::string& bytes, const std::array<int, 3>& corners);

}  // namespace halfshade::detail
