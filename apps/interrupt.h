#pragma once

#include <stop_token>
#include <thread>

namespace halfshade {

/// Turns the first Ctrl-C (SIGINT) or SIGTERM into a stop request, so that the program can write
/// what it has; the second one ends it at once with exit code 130. Make one before any other thread
/// starts: it blocks the signals for all of them.
class Interrupt {
 public:
  Interrupt();

  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread watcher_;
};

}  // namespace halfshade
