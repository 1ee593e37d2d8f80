#pragma once

#include <string>
#include <string_view>

namespace halfshade::detail {

/// A text as it can stand in HTML.
std::string escaped(std::string_view text);

/// Bytes as letters (RFC 4648), for pictures inside a page.
std::string base64(std::string_view bytes);

}  // namespace halfshade::detail
