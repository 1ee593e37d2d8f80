#pragma once

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string>
#include <vector>

namespace halfshade::test {

/// A source file and the text in it.
struct SourceText {
  std::string path;  ///< relative to the repository
  std::string text;
};

inline std::string read_whole(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// All .h and .cpp files in these folders of a repository and below.
inline std::vector<SourceText> sources_of(const std::filesystem::path& root,
                                          std::initializer_list<const char*> folders) {
  std::vector<SourceText> files;
  for (const char* folder : folders)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
        files.push_back({entry.path().lexically_relative(root).string(), read_whole(entry.path())});
  return files;
}

}  // namespace halfshade::test
