#pragma once

#include <functional>

namespace halfshade {

/// Runs `work` in a copy of the process, which is then thrown away, and says whether it got
/// through: false if it was ended by a signal or a sanitizer, or took more than `seconds` of CPU
/// time, ≥ 1. For libraries that crash or hang on damaged files; what they print is lost, and
/// exceptions are as good as returning. True, too, where there is no memory for a copy. `work` must
/// not wait for other threads.
bool survives(const std::function<void()>& work, int seconds);

}  // namespace halfshade
