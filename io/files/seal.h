#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace halfshade::detail {

/// FNV-1a in 64 bits: against accidents, not against forgers.
std::uint64_t checksum(std::string_view bytes);

/// Ends an XML file with a comment that holds a checksum of what is before it: VTK's reader can
/// crash on damaged data, so files are only given to it if `is_sealed` says they are as written.
std::string seal(std::string xml);
bool is_sealed(std::string_view bytes);

}  // namespace halfshade::detail
