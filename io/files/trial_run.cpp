#include "io/files/trial_run.h"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace halfshade {
namespace {

/// In the child.
void limit_time(int seconds) {
  const rlimit limit{static_cast<rlim_t>(seconds), static_cast<rlim_t>(seconds) + 1};
  setrlimit(RLIMIT_CPU, &limit);
}

/// In the child: a crash leaves nothing behind and prints nothing.
void be_quiet() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  const int nothing = open("/dev/null", O_WRONLY);
  dup2(nothing, STDOUT_FILENO);
  dup2(nothing, STDERR_FILENO);
}

}  // namespace

bool survives(const std::function<void()>& work, const TrialLimits& limits) {
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return true;
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGINT, SIGTERM})
      std::signal(signal, SIG_DFL);
    limit_time(limits.seconds);
    be_quiet();
    try {
      work();
    } catch (...) {  // which the caller's own run will meet
    }
    _exit(0);
  }
  int status = 0;
  rusage used{};
  while (wait4(child, &status, 0, &used) < 0)
    if (errno != EINTR) return true;
  rusage own{};
  getrusage(RUSAGE_SELF, &own);
  constexpr double kilobytes = 1000;  // of a megabyte
  const auto more = static_cast<double>(used.ru_maxrss - own.ru_maxrss);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 && more <= kilobytes * limits.megabytes;
}

}  // namespace halfshade
