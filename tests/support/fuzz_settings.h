#pragma once

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

/// Fuzz tests run longer, and otherwise, as the environment says.
namespace halfshade::test {

inline int fuzz_setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : otherwise;
}

/// HALFSHADE_FUZZ_SECONDS: what a test takes at least; 0 if not given. CPU time of this process and
/// of those it waited for: a test that is stopped has tried nothing.
class FuzzTime {
 public:
  bool goes_on() const { return cpu_seconds() < end_; }

 private:
  static double cpu_seconds() {
    double sum = 0;
    for (const int whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
      rusage usage{};
      getrusage(whose, &usage);
      for (const timeval& t : {usage.ru_utime, usage.ru_stime})
        sum += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    }
    return sum;
  }

  double end_ = cpu_seconds() + fuzz_setting("HALFSHADE_FUZZ_SECONDS", 0);
};

/// HALFSHADE_FUZZ_SEED.
inline int fuzz_seed(int otherwise) { return fuzz_setting("HALFSHADE_FUZZ_SEED", otherwise); }

/// The run that is watched.
inline volatile std::sig_atomic_t watched_run = 0;

inline void end_long_run(int) {
  char text[64];
  const int size =
      std::snprintf(text, sizeof text, "run %d takes too long\n", static_cast<int>(watched_run));
  if (size > 0 && write(STDERR_FILENO, text, static_cast<std::size_t>(size)) < 0) _exit(3);
  _exit(2);
}

/// Ends the program, and names the run, if it goes on for more than these seconds of CPU time:
/// machines may be busy. 0: it has ended.
inline void watch_run(int run, int seconds) {
  watched_run = run;
  std::signal(SIGPROF, end_long_run);
  const itimerval limit{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
}

}  // namespace halfshade::test
