#include "apps/run_end.h"

#include "apps/console.h"
#include "io/files/same_file.h"
#include "meshing/repair/repair_sentence.h"

#include <sys/resource.h>

namespace halfshade {
namespace {

const char* status_of(ExitCode code) {
  switch (code) {
    case exit_interrupted:
      return "interrupted";
    case exit_not_accurate:
      return "not_accurate";
    default:
      return "done";
  }
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

void print_warnings(const SceneFile& file, std::span<const Warning> of_result,
                    const Context& context) {
  if (context.common.quiet) return;
  for (const std::string& warning : file.warnings) complain("warning: {}\n", warning);
  for (const std::string& guess : file.guesses) complain("note: {}\n", guess);
  for (const Warning& warning : of_result) complain("warning: {}\n", warning.sentence);
}

std::vector<Warning> warnings_of(const SceneFile& file) {
  std::vector<Warning> warnings;
  for (const std::string& text : file.warnings)
    warnings.push_back(
        {text == file.lamps.limit ? Warning::Kind::lamps_uneven : Warning::Kind::in_files, text});
  for (const std::string& text : file.guesses) warnings.push_back({Warning::Kind::guessed, text});
  return warnings;
}

void print_repairs(const SoundScene& scene, const Context& context) {
  if (!context.common.verbose) return;
  for (const Repair& repair : scene.repairs)
    fmt::print(context.summary, "repair       {}\n", sentence(repair, scene));
}

RunInfo run_info(const Context& context, ExitCode code,
                 const std::vector<std::filesystem::path>& outputs) {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - context.start;
  return {context.provenance, outputs, status_of(code), elapsed.count(), peak_memory_bytes()};
}

void print_outputs(const Context& context, const std::vector<std::filesystem::path>& outputs) {
  for (const auto& path : outputs)
    if (!is_standard_stream(path)) fmt::print(context.summary, "wrote        {}\n", path.string());
}

ExitCode end_without_results() {
  complain("interrupted: too early for a result; nothing was written\n");
  return exit_interrupted;
}

}  // namespace halfshade
