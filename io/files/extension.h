#pragma once

#include <filesystem>
#include <string>

namespace halfshade {

/// The path's extension with its dot, in small letters: how every reader and writer tells a format.
std::string extension_of(const std::filesystem::path& path);

}  // namespace halfshade
