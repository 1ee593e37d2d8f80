#pragma once

#include "solver/factors/factor_matrix.h"

#include <array>
#include <filesystem>
#include <string_view>

namespace halfshade {

/// The columns of F.names.csv that tell where rows lie, as RowPlace has them.
inline constexpr std::array<std::string_view, 9> place_columns = {
    "centre_x", "centre_y", "centre_z", "normal_x", "normal_y",
    "normal_z", "extent_x", "extent_y", "extent_z"};

/// The table of names and areas that lies beside a matrix: F.names.csv for F.mtx.
std::filesystem::path factor_names_file(const std::filesystem::path& path);

/// Reads form factors as write_factors writes them: F.mtx (MatrixMarket, coordinate real general)
/// and F.names.csv beside it, with the columns surface, area, space, row_sum, error. Those that are
/// left_out and place_columns are read if they are there, others passed over. `backs` is not saved
/// and 0; of the report there is row_sum_error_max. Throws Error(usage) unless the extension is
/// .mtx, Error(invalid_input) with file and line for what is no such matrix and as
/// require_rows_that_add_up, and Error(too_large) if it would not fit into memory.
FactorMatrix read_factors(const std::filesystem::path& path);

}  // namespace halfshade
