#include "tests/architecture/length_rules.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade::test {

int line_count(const std::string& text) {
  const auto ends = std::count(text.begin(), text.end(), '\n');
  return static_cast<int>(ends) + (text.empty() || text.back() == '\n' ? 0 : 1);
}

std::vector<std::string> too_long(const std::vector<SourceText>& files) {
  std::vector<std::string> sentences;
  for (const SourceText& file : files)
    if (const int lines = line_count(file.text); lines > most_lines)
      sentences.push_back(fmt::format("{} has {} lines, more than {}: split it by subject",
                                      file.path, lines, most_lines));
  return sentences;
}

}  // namespace halfshade::test
