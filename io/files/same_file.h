#pragma once

#include <filesystem>

namespace halfshade {

/// True for "-", which stands for the standard input or output.
bool is_standard_stream(const std::filesystem::path& path);

/// Where a path leads to through symbolic links, also to a file that is not there yet. The path
/// itself if that cannot be found out.
std::filesystem::path resolved(const std::filesystem::path& path);

/// True if writing to one of the paths would replace the other: the same file under any name, by
/// symbolic or hard links, or the same place where no file is yet. Devices, pipes and standard
/// streams keep nothing that could be lost and are never the same. An empty path is no file.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace halfshade
