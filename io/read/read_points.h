#pragma once

#include "solver/direct/direct_light.h"

#include <filesystem>
#include <string>
#include <vector>

namespace halfshade {

/// Points as a file gives them, with what else its rows hold.
struct PointTable {
  std::vector<SurfacePoint> points;
  std::string header;             ///< names of all columns; never empty
  std::vector<std::string> rows;  ///< as in the file, one a point
  char separator = ',';
};

/// Reads points from a text table: columns x, y, z, nx, ny, nz in any order, named in the first row
/// (upper or lower case), among others that are kept and not looked at; or six columns of numbers
/// in that order without names. Separated by commas, semicolons or tabs, as the first row shows.
/// "-" is the standard input. Empty lines and comments (#) are skipped. Normals may have any length
/// but zero. Throws Error(invalid_input) with file and line for anything else.
PointTable read_points(const std::filesystem::path& path);

/// Points in the form of a table that would read back as the same ones.
PointTable point_table(std::vector<SurfacePoint> points);

}  // namespace halfshade
