#include "apps/interrupt.h"

#include <csignal>
#include <ctime>
#include <unistd.h>

namespace halfshade {

Interrupt::Interrupt() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([signals, source = source_](const std::stop_token& end) mutable {
    const timespec patience{0, 50'000'000};
    while (!end.stop_requested()) {
      if (sigtimedwait(&signals, nullptr, &patience) < 0) continue;
      if (source.stop_requested()) _exit(130);
      source.request_stop();
    }
  });
}

}  // namespace halfshade
