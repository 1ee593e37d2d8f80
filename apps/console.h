#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace halfshade {

/// Prints to stderr. Whether that works does not matter to a run.
template <class... T>
void complain(fmt::format_string<T...> format, T&&... values) {
  std::fputs(fmt::format(format, std::forward<T>(values)...).c_str(), stderr);
}

}  // namespace halfshade
