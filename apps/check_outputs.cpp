#include "apps/check_outputs.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

namespace halfshade {

void check_output(const std::filesystem::path& file, const FileFormats& formats) {
  if (file.empty()) return;
  require_format(file, formats);
  require_folder(file);
}

void require_folder(const std::filesystem::path& file) {
  const auto folder = file.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder))
    throw Error(ErrorCode::unwritable, file.string(),
                fmt::format("the folder '{}' does not exist", folder.string()));
}

}  // namespace halfshade
