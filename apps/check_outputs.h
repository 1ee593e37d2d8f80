#pragma once

#include <filesystem>

namespace halfshade {

/// Throws Error(unwritable) if the folder that a file is to be written to does not exist: worth
/// telling before an hour of computing. An empty path is fine.
void require_folder(const std::filesystem::path& file);

}  // namespace halfshade
