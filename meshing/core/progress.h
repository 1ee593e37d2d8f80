#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace halfshade {

/// How a long call tells what it is doing, and how it is told to stop. The default does neither.
/// Functions that take one return a valid partial result when they are stopped and say so in their
/// report.
struct Progress {
  std::stop_token stop;
  /// Called with the name of the stage and the fraction done, in [0,1]; never from two threads at
  /// once.
  std::function<void(std::string_view stage, double fraction)> report;

  bool stopped() const { return stop.stop_requested(); }
  void operator()(std::string_view stage, double fraction) const {
    if (report) report(stage, fraction);
  }
};

}  // namespace halfshade
