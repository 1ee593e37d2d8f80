#pragma once

#include "io/files/extension.h"
#include "io/write/run_info.h"
#include "solver/factors/factor_matrix.h"

#include <filesystem>
#include <vector>

namespace halfshade {

inline constexpr FileFormats factor_formats = {"form factors", {".csv", ".mtx"}};

/// The files that write_factors makes of a path: itself, and with a .mtx the table of names and
/// areas beside it, F.names.csv.
std::vector<std::filesystem::path> factor_files(const std::filesystem::path& path);

/// Writes form factors by extension, as many digits as it takes to read back the same numbers; "-"
/// writes a table to the standard output.
/// * .csv: comments (#) with program, command and unit, then the header
/// surface,area,NAME…,space,row_sum,error and a row for each surface: F(row, column) is the share
/// of what leaves the row's surface that reaches the column's. Names with commas or quotes are
/// quoted.
/// * .mtx: the same matrix as MatrixMarket coordinates, zeros left out, and beside it F.names.csv
/// with surface,area,space,row_sum,error,left_out in the order of the rows, and by face also where
/// each lies: centre_x … extent_z.
/// Throws Error(usage) for another extension, Error(unwritable) if it cannot be written.
void write_factors(const FactorMatrix& matrix, const Provenance& provenance,
                   const std::filesystem::path& path);

/// Writes what every report begins with, unit, surfaces, pairs of surfaces (clear, partial), points
/// and rays, rows_not_reached, row_sum_error_max, error_max, backs_max, left_out, left_out_max,
/// enforced_by (null where nothing was scaled), repairs, interrupted, outputs. Throws
/// Error(unwritable).
void write_report(const FactorMatrix& matrix, const RunInfo& run,
                  const std::filesystem::path& path);

}  // namespace halfshade
