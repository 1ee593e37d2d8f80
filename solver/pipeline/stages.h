#pragma once

#include <chrono>
#include <cstddef>
#include <ctime>
#include <string>
#include <vector>

namespace halfshade {

/// What one stage of a pipeline did.
struct StageReport {
  std::string name;
  double seconds = 0;
  std::size_t count = 0;  ///< of what the stage makes: surfaces, elements, factors, iterations
  std::string left_out_because;  ///< empty if it ran
  double cpu_seconds = 0;        ///< of all threads of the program
};

/// Times the stages of a pipeline.
class Stages {
 public:
  explicit Stages(std::vector<StageReport>& reports) : reports_(reports) {}

  /// Runs `stage`, which returns how many things it made.
  template <class Stage>
  void run(const char* name, Stage stage) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu_start = std::clock();
    const std::size_t count = stage();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const double cpu = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    end({name, elapsed.count(), count, {}, cpu});
  }

  void leave_out_if(bool needless, const char* name, const std::string& because) {
    if (needless) reports_.push_back({name, 0, 0, because});
  }

 private:
  /// What the stage took beside its result, the next one is to have.
  void end(StageReport report);

  std::vector<StageReport>& reports_;
};

}  // namespace halfshade
