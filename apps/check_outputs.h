#pragma once

#include "io/files/extension.h"

#include <filesystem>

namespace halfshade {

/// Mistakes worth telling before an hour of computing. Throws Error(usage) unless the file's
/// extension is one of `formats`, and as require_folder. An empty path is fine.
void check_output(const std::filesystem::path& file, const FileFormats& formats);

/// Throws Error(unwritable) if the folder that a file is to be written to does not exist. An empty
/// path is fine.
void require_folder(const std::filesystem::path& file);

}  // namespace halfshade
