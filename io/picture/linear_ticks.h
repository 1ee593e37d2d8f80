#pragma once

#include "io/picture/log_axis.h"

namespace halfshade::detail {

/// Round numbers, steps of 1, 2 or 5 times a power of ten, in [low, high]: no more than `most` ≥ 2
/// where that leaves two. All have labels. Whole numbers only if `is_whole`. Precondition: low <
/// high, finite.
std::vector<Tick> linear_ticks(double low, double high, int most, bool is_whole = false);

}  // namespace halfshade::detail
