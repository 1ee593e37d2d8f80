#pragma once

#include <array>

namespace halfshade {

/// Two points.
using Link = std::array<int, 2>;

inline Link sorted_link(int a, int b) { return a < b ? Link{a, b} : Link{b, a}; }

}  // namespace halfshade
