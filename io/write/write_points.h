#pragma once

#include "io/read/read_points.h"
#include "io/write/write_result.h"
#include "solver/pipeline/light_at_points.h"
#include "solver/reference/reference_light.h"

#include <filesystem>
#include <span>

namespace halfshade {

inline constexpr FileFormats point_formats = {"points", {".csv", ".vtp"}};
inline constexpr FileFormats value_formats = {"values at points", {".csv"}};

/// Writes points with the light at each, by extension; "-" writes a table to the standard output.
/// `light` may be shorter than the table: what comes after was not computed and is left out, and
/// the file says so, a table in a comment (#) before its header.
/// * .csv: the rows of the table followed by H_r, H_g, H_b (irradiance in W/m²) and visible, with
/// as many digits as it takes to read back the same numbers;
/// * .vtp: points with the arrays irradiance, visible, region (0 lit, 1 penumbra, 2 umbra, 3 away)
/// and normal; field data interrupted (0 or 1).
/// Throws Error(usage) for another extension, Error(unwritable) if it cannot be written.
void write_points(const PointTable& table, std::span<const DirectLight> light,
                  const std::filesystem::path& path);

/// The same of what a solution says, in a table only: H_r, H_g, H_b (all irradiance), D_r, D_g, D_b
/// (direct).
void write_points(const PointTable& table, std::span<const PointLight> light,
                  const std::filesystem::path& path);

/// The same of light that comes with a standard error: a table has H_r, H_g, H_b and their standard
/// errors H_r_error, …, then the same of direct light, D_r, …; a .vtp has irradiance,
/// irradiance_error, direct_irradiance, direct_irradiance_error and normal.
void write_points(const PointTable& table, const ReferenceLight& light,
                  const std::filesystem::path& path);

}  // namespace halfshade
