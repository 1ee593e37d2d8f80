#pragma once

#include "meshing/core/types.h"

#include <vtkPointSet.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <string>
#include <vector>

namespace halfshade::detail {

/// Throws Error(invalid_input) about a file.
[[noreturn]] void reject(const std::filesystem::path& file, const std::string& sentence);

/// What VTK reads from a .vtu or .vtp that halfshade has written; prints nothing. Throws
/// Error(invalid_input) for a file that cannot be opened, is damaged or from elsewhere.
vtkSmartPointer<vtkPointSet> read_sealed(const std::filesystem::path& file);

/// The points that a cell names. Throws Error(invalid_input) for one that is not there.
std::vector<int> nodes_of(vtkPointSet* grid, vtkIdType cell, const std::filesystem::path& file);

/// Throws Error(invalid_input) if one is not finite.
std::vector<Vec3> points_of(vtkPointSet* grid, const std::filesystem::path& file);

}  // namespace halfshade::detail
