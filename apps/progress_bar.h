#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace halfshade {

/// One line on a terminal's stderr: stage, bar, time left. Draws nothing elsewhere.
class ProgressBar {
 public:
  /// `shown` false: draws nothing.
  explicit ProgressBar(bool shown);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `fraction` of the stage done, in [0, 1].
  void update(std::string_view stage, double fraction);

  /// Removes the line.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool shown_;
  bool drawn_ = false;
  std::string stage_;
  Clock::time_point stage_start_, last_drawn_;
};

}  // namespace halfshade
