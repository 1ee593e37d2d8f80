#pragma once

#include "solver/factors/factor_matrix.h"

#include <filesystem>

namespace halfshade {

/// The table of names and areas that lies beside a matrix: F.names.csv for F.mtx.
std::filesystem::path factor_names_file(const std::filesystem::path& path);

/// Reads form factors as write_factors writes them: F.mtx (MatrixMarket, coordinate real general)
/// and F.names.csv beside it, with the columns surface, area, space, row_sum, error. `backs` is not
/// saved and 0; of the report there is row_sum_error_max. Throws Error(usage) unless the extension
/// is .mtx, Error(invalid_input) with file and line for what is no such matrix, and
/// Error(too_large) if it would not fit into memory.
FactorMatrix read_factors(const std::filesystem::path& path);

}  // namespace halfshade
