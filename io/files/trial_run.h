#pragma once

#include <functional>

namespace halfshade {

struct TrialLimits {
  int seconds = 10;         ///< of CPU time, ≥ 1
  double megabytes = 1000;  ///< more than the process has had so far
};

/// Runs `work` in a copy of the process, which is then thrown away, and says whether it got
/// through: false if it was ended by a signal or a sanitizer, or took more than the limits. For
/// libraries that crash or hang on damaged files; what they print is lost, and exceptions are as
/// good as returning. True, too, where there is no memory for a copy. `work` must not wait for
/// other threads.
bool survives(const std::function<void()>& work, const TrialLimits& limits);

}  // namespace halfshade
