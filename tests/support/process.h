#pragma once

#include "tests/support/files.h"

#include <array>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

/// Runs programs as a user would.
namespace halfshade::test {

struct Outcome {
  int exit_code = -1;  ///< −1 if a signal ended it
  std::string out, err;
};

/// Starts `arguments` (the program first) in `folder`, which must exist.
inline pid_t start_program(std::vector<std::string> arguments,
                           const std::filesystem::path& folder) {
  const auto out = folder / ".stdout", err = folder / ".stderr";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    if (chdir(folder.c_str()) != 0) _exit(126);
    dup2(open(out.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644), STDOUT_FILENO);
    dup2(open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644), STDERR_FILENO);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  return child;
}

/// Waits for what start_program started, and collects what it printed.
inline Outcome wait_for(pid_t child, const std::filesystem::path& folder) {
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder / ".stdout"),
          contents(folder / ".stderr")};
}

/// Runs `arguments` (the program first) in `folder` and collects what it prints. Sends SIGINT after
/// `interrupt_after` if that is positive.
inline Outcome run_program(std::vector<std::string> arguments, const std::filesystem::path& folder,
                           std::chrono::milliseconds interrupt_after = {}) {
  const pid_t child = start_program(std::move(arguments), folder);
  if (interrupt_after.count() > 0) {
    std::this_thread::sleep_for(interrupt_after);
    kill(child, SIGINT);
  }
  return wait_for(child, folder);
}

}  // namespace halfshade::test
