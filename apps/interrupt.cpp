#include "apps/interrupt.h"

#include "apps/commands.h"

#include <chrono>
#include <csignal>
#include <ctime>
#include <fcntl.h>
#include <unistd.h>

namespace halfshade {

namespace {

/// How often the watcher looks whether it is to end, in ns.
constexpr long patience_ns = 50'000'000;
/// Signals that come closer together are one.
constexpr std::chrono::seconds one_press(1);

/// Blocked signals arrive even if they are ignored; hence not those.
sigset_t signals_to_watch() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      sigaddset(&signals, signal);
  }
  return signals;
}

}  // namespace

Interrupt::Interrupt() {
  const sigset_t signals = signals_to_watch();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([signals, source = source_](const std::stop_token& end) mutable {
    using Clock = std::chrono::steady_clock;
    const timespec patience{0, patience_ns};
    Clock::time_point first;
    while (!end.stop_requested()) {
      if (sigtimedwait(&signals, nullptr, &patience) < 0) continue;
      if (!source.stop_requested())
        first = Clock::now();
      else if (Clock::now() - first >= one_press)
        _exit(exit_interrupted);
      source.request_stop();
    }
  });
}

void let_writes_fail() {
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", O_RDONLY);  // writing to it fails
}

}  // namespace halfshade
