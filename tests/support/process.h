#pragma once

#include "tests/support/files.h"
#include "tests/support/places.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <sstream>
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

/// Runs the program in the same way with `arguments` behind its name.
inline Outcome run_halfshade(std::vector<std::string> arguments,
                             const std::filesystem::path& folder,
                             std::chrono::milliseconds interrupt_after = {}) {
  arguments.insert(arguments.begin(), program);
  return run_program(std::move(arguments), folder, interrupt_after);
}

/// Splits at blanks.
inline std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> result;
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

/// The examples in the help of a command: what follows `halfshade <command>` in its lines.
inline std::vector<std::vector<std::string>> examples_of(const std::string& help,
                                                         const std::string& command) {
  std::vector<std::vector<std::string>> examples;
  std::istringstream stream(help);
  for (std::string line; std::getline(stream, line);) {
    const std::vector<std::string> all = words(line);
    if (all.size() > 2 && all[0] == "halfshade" && all[1] == command)
      examples.emplace_back(all.begin() + 2, all.end());
  }
  return examples;
}

/// Expects that a program says in one sentence what is wrong, and nothing else.
inline void expect_sentence(const Outcome& outcome, int exit_code, const std::string& part) {
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err.rfind("halfshade: ", 0), 0u) << outcome.err;
  EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

}  // namespace halfshade::test
