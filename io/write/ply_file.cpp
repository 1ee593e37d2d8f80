#include "io/write/ply_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade::detail {
namespace {

/// The text with blanks for line ends: a comment ends with its line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

std::string ply_head(const char* format, const Provenance& provenance, const std::string& unit) {
  return fmt::format(
      "ply\n"
      "format {} 1.0\n"
      "comment halfshade {}\n"
      "comment command line: {}\n"
      "comment unit: {}\n",
      format, one_line(provenance.version), one_line(provenance.command_line), one_line(unit));
}

}  // namespace halfshade::detail
