#include "io/files/seal.h"

#include <fmt/format.h>

#include <cstdint>

namespace halfshade::detail {
namespace {

/// The comment for what precedes it. FNV-1a in 64 bits: against accidents, not against forgers.
std::string comment(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("<!-- halfshade checksum {:016x} -->\n", hash);
}

}  // namespace

std::string seal(std::string xml) {
  const std::string end = comment(xml);
  return std::move(xml) + end;
}

bool is_sealed(std::string_view bytes) {
  static const std::size_t length = comment({}).size();
  return bytes.size() > length &&
         bytes.substr(bytes.size() - length) == comment(bytes.substr(0, bytes.size() - length));
}

}  // namespace halfshade::detail
