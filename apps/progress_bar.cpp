#include "apps/progress_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace halfshade {
namespace {

constexpr int bar_width = 30;
constexpr std::chrono::milliseconds redraw_interval(100);
/// Estimates from less time than this jump about.
constexpr double seconds_before_estimate = 1;

std::string time_left(double elapsed, double fraction) {
  if (elapsed < seconds_before_estimate || !(fraction > 0)) return {};
  const int seconds = static_cast<int>(elapsed * (1 - fraction) / fraction + 0.5);
  return seconds < 60 ? fmt::format("{} s left", seconds)
                      : fmt::format("{} min {:02} s left", seconds / 60, seconds % 60);
}

}  // namespace

ProgressBar::ProgressBar(bool shown) : shown_(shown && isatty(STDERR_FILENO)) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::update(std::string_view stage, double fraction) {
  if (!shown_) return;
  const auto now = Clock::now();
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = now;
  } else if (now - last_drawn_ < redraw_interval) {
    return;
  }
  last_drawn_ = now;
  drawn_ = true;
  fraction = std::clamp(fraction, 0., 1.);
  const int full = static_cast<int>(fraction * bar_width);
  const double elapsed = std::chrono::duration<double>(now - stage_start_).count();
  fmt::print(stderr, "\r\x1b[K{:<16} [{:#<{}}{:.<{}}] {:3.0f} % {}", stage_, "", full, "",
             bar_width - full, 100 * fraction, time_left(elapsed, fraction));
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace halfshade
