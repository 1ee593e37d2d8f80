#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace halfshade {

/// Calls `write` with a temporary path beside `target` (same folder, same extension; the file
/// exists and is empty) and renames the result over `target`: the file appears whole or not at all.
/// Removes the temporary file if `write` throws. A symbolic link is followed. A target that is
/// neither a file nor a folder, such as /dev/stdout, is written in place, for it cannot be
/// replaced. Throws Error(unwritable) if the folder does not exist or cannot be written, or if the
/// target is there and must not be written.
void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path&)>& write);

/// The same for contents that are in memory; "-" is the standard output.
void write_atomically(const std::filesystem::path& target, std::string_view bytes);

struct FileBytes {
  std::filesystem::path target;
  std::string bytes;
};

/// The same for files that belong together, none of them the standard output: all are complete
/// before one is in its place, so that where one cannot be written, all stay as they were.
void write_together(std::span<const FileBytes> files);

}  // namespace halfshade
