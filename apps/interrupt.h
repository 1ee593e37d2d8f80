#pragma once

#include <stop_token>
#include <thread>

namespace halfshade {

/// Turns the first Ctrl-C (SIGINT), SIGTERM or SIGHUP into a stop request, so that the program can
/// write what it has; another one, a second or more later, ends it at once with exit code 130.
/// Within a second it counts as the same one: a terminal and a wrapper may both deliver it. Signals
/// that are ignored when the program starts, as under nohup, stay so. Make one before any other
/// thread starts: it blocks the signals for all of them.
class Interrupt {
 public:
  Interrupt();

  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread watcher_;
};

/// Makes writes beyond a file-size limit and to closed pipes fail with an error, which is told,
/// instead of ending the program, also where the program starts with closed standard streams, whose
/// numbers files would get otherwise.
void let_writes_fail();

}  // namespace halfshade
