#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace halfshade {

/// The path's extension with its dot, in small letters: how every reader and writer tells a format.
std::string extension_of(const std::filesystem::path& path);

/// What a writer writes, in the plural, and under which extensions.
struct FileFormats {
  std::string_view what;
  std::array<std::string_view, 4> extensions;  ///< with dots, in small letters; at the end empty
};

/// True if the path's extension is one of these.
bool has_format(const std::filesystem::path& path, const FileFormats& formats);

/// Throws Error(usage) unless has_format: "results are written as .vtu, .vtp or .ply, not as …".
void require_format(const std::filesystem::path& path, const FileFormats& formats);

}  // namespace halfshade
