#include "apps/interrupt.h"

#include "apps/commands.h"

#include <csignal>
#include <ctime>
#include <unistd.h>

namespace halfshade {

namespace {

/// How often the watcher looks whether it is to end, in ns.
constexpr long patience_ns = 50'000'000;

}  // namespace

Interrupt::Interrupt() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([signals, source = source_](const std::stop_token& end) mutable {
    const timespec patience{0, patience_ns};
    while (!end.stop_requested()) {
      if (sigtimedwait(&signals, nullptr, &patience) < 0) continue;
      if (source.stop_requested()) _exit(exit_interrupted);
      source.request_stop();
    }
  });
}

}  // namespace halfshade
