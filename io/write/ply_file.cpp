#include "io/write/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace halfshade::detail {
namespace {

/// The text with blanks for line ends: a comment ends with its line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

std::string ply_head(const Provenance& provenance, const std::string& unit) {
  return fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment halfshade {}\n"
      "comment command line: {}\n"
      "comment unit: {}\n",
      one_line(provenance.version), one_line(provenance.command_line), one_line(unit));
}

void put_triangle(std::string& bytes, const std::array<int, 3>& corners) {
  put(bytes, std::uint8_t{3});
  for (const int p : corners) put(bytes, static_cast<std::int32_t>(p));
}

}  // namespace halfshade::detail
