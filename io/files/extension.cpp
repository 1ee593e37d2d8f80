#include "io/files/extension.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

/// ".a", ".a or .b", ".a, .b or .c".
std::string listed(const FileFormats& formats) {
  std::string list;
  for (std::size_t k = 0; k < formats.extensions.size() && !formats.extensions[k].empty(); ++k) {
    const bool is_last = k + 1 == formats.extensions.size() || formats.extensions[k + 1].empty();
    list += k == 0 ? "" : is_last ? " or " : ", ";
    list += formats.extensions[k];
  }
  return list;
}

}  // namespace

std::string extension_of(const std::filesystem::path& path) {
  std::string result = path.extension().string();
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  return result;
}

bool has_format(const std::filesystem::path& path, const FileFormats& formats) {
  const std::string extension = extension_of(path);
  return !extension.empty() && std::find(formats.extensions.begin(), formats.extensions.end(),
                                         extension) != formats.extensions.end();
}

void require_format(const std::filesystem::path& path, const FileFormats& formats) {
  if (!has_format(path, formats))
    throw Error(ErrorCode::usage, path.string(),
                fmt::format("{} are written as {}, not as '{}'", formats.what, listed(formats),
                            path.extension().string()));
}

}  // namespace halfshade
