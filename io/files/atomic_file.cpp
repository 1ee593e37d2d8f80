#include "io/files/atomic_file.h"

#include "io/files/same_file.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <system_error>
#include <unistd.h>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& target, const std::string& reason) {
  throw Error(ErrorCode::unwritable, target.string(),
              fmt::format("the file cannot be written ({})", reason));
}

[[noreturn]] void refuse(const fs::path& target, int error) {
  refuse(target, std::generic_category().message(error));
}

/// Opens a file that did not exist before, with the permissions any new file gets.
fs::path make_temporary(const fs::path& target, const fs::path& folder) {
  for (int attempt = 0;; ++attempt) {
    const fs::path path =
        folder / fmt::format(".halfshade-{}-{}{}", getpid(), attempt, target.extension().string());
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) {
      close(file);
      return path;
    }
    if (errno != EEXIST && errno != EINTR) refuse(target, errno);
  }
}

/// Returns 0 or the error.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written >= 0)
      bytes.remove_prefix(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      return errno;
  }
  return 0;
}

/// `target` is the name to complain about.
void write_bytes(const fs::path& path, std::string_view bytes, const fs::path& target) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) refuse(target, errno);
  int error = write_all(file, bytes);
  if (close(file) != 0 && error == 0) error = errno;
  if (error != 0) refuse(target, error);
}

/// Removes the temporary file unless it has been moved away.
struct Remover {
  fs::path path;
  explicit Remover(fs::path p) : path(std::move(p)) {}
  Remover(const Remover&) = delete;
  Remover& operator=(const Remover&) = delete;
  ~Remover() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

void copy_into(const fs::path& from, const fs::path& target) {
  std::ostringstream bytes;
  bytes << std::ifstream(from, std::ios::binary).rdbuf();
  write_bytes(target, bytes.view(), target);
}

/// Neither a file nor a folder nor free: a device or a pipe, which cannot be replaced.
bool is_device(const fs::path& target) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) refuse(target, EISDIR);
  return fs::exists(status) && !fs::is_regular_file(status);
}

/// Where the file comes to stand. A file that must not be written must not be replaced, either.
fs::path place_of(const fs::path& target) {
  std::error_code error;
  const bool is_link = fs::is_symlink(fs::symlink_status(target, error));
  fs::path place = is_link ? resolved(target) : target;
  if (!place.has_filename()) refuse(target, target.empty() ? ENOENT : EISDIR);
  if (fs::exists(place, error) && access(place.c_str(), W_OK) != 0) refuse(target, errno);
  return place;
}

}  // namespace

void write_atomically(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  std::error_code error;
  if (is_device(target)) {
    const Remover temporary(make_temporary(target, fs::temp_directory_path(error)));
    write(temporary.path);
    return copy_into(temporary.path, target);
  }
  const fs::path place = place_of(target);
  const Remover temporary(make_temporary(target, place.parent_path()));
  write(temporary.path);
  fs::rename(temporary.path, place, error);
  if (error) refuse(target, error.message());
}

void write_atomically(const fs::path& target, std::string_view bytes) {
  if (is_standard_stream(target)) {
    if (const int error = write_all(STDOUT_FILENO, bytes); error != 0)
      refuse("the standard output", error);
  } else if (is_device(target)) {
    write_bytes(target, bytes, target);
  } else {
    write_atomically(target, [&](const fs::path& path) { write_bytes(path, bytes, target); });
  }
}

void write_together(std::span<const FileBytes> files) {
  if (files.empty()) return;
  const auto& [target, bytes] = files.front();
  // All are there under other names before the first gets its own.
  write_atomically(target, [&](const fs::path& path) {
    write_bytes(path, bytes, target);
    write_together(files.subspan(1));
  });
}

}  // namespace halfshade
