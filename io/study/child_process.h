#pragma once

#include <cstddef>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

namespace halfshade {

struct ChildOptions {
  std::filesystem::path log;  ///< gets what the child prints; replaced
  double time_limit = 0;      ///< seconds after which it is ended; 0: none
};

/// How a program ran.
struct ChildEnd {
  int exit_code = -1;      ///< −1: a signal ended it
  bool timed_out = false;  ///< it was ended for that
  bool stopped = false;    ///< it was ended because the caller was to stop
  double seconds = 0;
  double cpu_seconds = 0;
  std::size_t peak_memory_bytes = 0;
};

/// Runs a program (the first of the arguments, a path) to its end; alone in a group of processes,
/// so that a terminal's Ctrl-C reaches the caller only, and killed if the caller dies. It is asked
/// to end by SIGTERM and killed two seconds later. Throws Error(unwritable) if the log cannot be
/// written, Error(invalid_input) if the program cannot be started.
ChildEnd run_child(const std::vector<std::string>& arguments, const ChildOptions& options,
                   const std::stop_token& stop);

/// The path of the program that is running.
std::filesystem::path this_program();

}  // namespace halfshade
