#pragma once

#include "tests/support/expect_error.h"
#include "tests/support/places.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

/// What tests that read or write files need; expect_error, too.
namespace halfshade::test {

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A file of the folder data/.
inline std::filesystem::path data_file(std::string_view name) {
  return std::filesystem::path(data_folder) / name;
}

/// A new, empty folder for one test, removed with what is in it.
class TempDir {
 public:
  TempDir() {
    // Not from the process id: a test that was killed has left its folder, and ids come again.
    std::string name = (std::filesystem::temp_directory_path() / "halfshade_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw std::filesystem::filesystem_error("mkdtemp", name, {errno, std::generic_category()});
    path_ = name;
  }
  ~TempDir() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Writes a file and returns its path.
  std::filesystem::path write(const std::string& name, std::string_view content) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    // Some file systems wait for the disk when a file is cut to nothing and written anew.
    std::filesystem::remove(file);
    std::ofstream stream(file, std::ios::binary);
    stream << content;
    EXPECT_TRUE(stream.flush()) << file;
    return file;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace halfshade::test
