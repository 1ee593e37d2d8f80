#pragma once

#include <filesystem>
#include <functional>

namespace halfshade {

/// Calls `write` with a temporary path beside `target` (same folder, same extension) and renames
/// the result over `target`: the file appears whole or not at all. Removes the temporary file if
/// `write` throws. Throws Error(unwritable) if the folder does not exist or cannot be written.
void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path&)>& write);

}  // namespace halfshade
