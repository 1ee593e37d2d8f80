#include "io/files/seal.h"

#include <fmt/format.h>

namespace halfshade::detail {
namespace {

/// The comment for what precedes it.
std::string comment(std::string_view bytes) {
  return fmt::format("<!-- halfshade checksum {:016x} -->\n", checksum(bytes));
}

}  // namespace

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

std::string seal(std::string xml) { return std::move(xml.append(comment(xml))); }

bool is_sealed(std::string_view bytes) {
  static const std::size_t length = comment({}).size();
  return bytes.size() > length &&
         bytes.substr(bytes.size() - length) == comment(bytes.substr(0, bytes.size() - length));
}

}  // namespace halfshade::detail
