#include "io/study/child_process.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace halfshade {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds least_pause(1), most_pause(50);
constexpr std::chrono::seconds grace(2);

/// What only the child runs: nothing that allocates, for other threads may hold locks.
[[noreturn]] void become(char* const* argv, int log, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execv(argv[0], argv);
  _exit(127);
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

pid_t start(const std::vector<std::string>& arguments, const std::filesystem::path& log_path) {
  const int log = open(log_path.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0644);
  if (log < 0)
    throw Error(
        ErrorCode::unwritable, log_path.string(),
        fmt::format("the file cannot be written ({})", std::generic_category().message(errno)));
  std::vector<std::string> words = arguments;
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) become(argv.data(), log, parent);
  const int error = errno;
  close(log);
  if (child < 0)
    throw Error(
        ErrorCode::invalid_input, arguments.front(),
        fmt::format("a process cannot be started ({})", std::generic_category().message(error)));
  return child;
}

}  // namespace

ChildEnd run_child(const std::vector<std::string>& arguments, const ChildOptions& options,
                   const std::stop_token& stop) {
  const auto begin = Clock::now();
  const pid_t child = start(arguments, options.log);
  ChildEnd end;
  Clock::time_point asked;
  rusage usage{};
  int status = 0;
  std::chrono::milliseconds pause = least_pause;
  for (pid_t waited = 0; waited == 0;) {
    waited = wait4(child, &status, WNOHANG, &usage);
    const auto now = Clock::now();
    end.seconds = std::chrono::duration<double>(now - begin).count();
    if (waited != 0) break;
    if (end.timed_out || end.stopped) {
      if (now - asked > grace) kill(child, SIGKILL);
    } else {
      end.stopped = stop.stop_requested();
      end.timed_out = !end.stopped && options.time_limit > 0 && end.seconds > options.time_limit;
      if (end.stopped || end.timed_out) {
        kill(child, SIGTERM);
        asked = now;
      }
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, most_pause);
  }
  end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  end.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  end.peak_memory_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
  return end;
}

std::filesystem::path this_program() { return std::filesystem::read_symlink("/proc/self/exe"); }

}  // namespace halfshade
