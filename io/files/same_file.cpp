#include "io/files/same_file.h"

#include <system_error>

namespace halfshade {

namespace fs = std::filesystem;

bool is_standard_stream(const fs::path& path) { return path == "-"; }

fs::path resolved(const fs::path& path) {
  constexpr int most_links = 40;  // as the kernel
  std::error_code error;
  fs::path place = path;
  for (int k = 0; k < most_links && fs::is_symlink(fs::symlink_status(place, error)); ++k)
    place = place.parent_path() / fs::read_symlink(place, error);
  const fs::path canonical = fs::weakly_canonical(fs::absolute(place, error), error);
  return error || canonical.empty() ? path : canonical;
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  if (a.empty() || b.empty() || is_standard_stream(a) || is_standard_stream(b)) return false;
  std::error_code error;
  const fs::file_status status_a = fs::status(a, error), status_b = fs::status(b, error);
  if (!fs::exists(status_a) && !fs::exists(status_b)) return resolved(a) == resolved(b);
  return fs::is_regular_file(status_a) && fs::is_regular_file(status_b) &&
         fs::equivalent(a, b, error);
}

}  // namespace halfshade
