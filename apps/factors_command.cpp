#include "apps/command_files.h"
#include "apps/console.h"
#include "apps/factor_warnings.h"
#include "apps/run_end.h"
#include "io/files/same_file.h"
#include "io/read/read_factors.h"
#include "io/write/write_factors.h"
#include "solver/factors/saved_factors.h"

#include <fmt/format.h>

#include <cstdio>

namespace halfshade {
namespace {

CommandFiles checked_files(const FactorsCommand& command, const CommonOptions& common) {
  CommandFiles files = scene_files(command.scene, command.materials, common);
  add_factor_inputs(files, "--from", command.from);
  add_outputs(files, "-o", factor_files(command.output));
  require_apart(files);
  require_place(common.json);
  if (!is_standard_stream(command.output))
    for (const auto& file : factor_files(command.output)) check_output(file, factor_formats);
  return files;
}

void print_doubts(const SceneFile& file, const FactorMatrix& matrix, FactorUnit unit,
                  const Context& context) {
  print_warnings(file, warnings_of(file.scene, matrix), context);
  if (context.common.quiet) return;
  for (const std::string& note :
       {note_of(file.scene, matrix), missing_rows(file.scene, matrix, unit),
        rows_without_faces(file, unit)})
    if (!note.empty()) complain("note: {}\n", note);
}

void print_summary(const FactorMatrix& matrix, FactorMethod asked, const Context& context) {
  const FactorReport& report = matrix.report;
  std::FILE* out = context.summary;
  print_repairs(matrix.scene, context);
  fmt::print(out, "surfaces     {}\n", matrix.names.size());
  if (report.rays > 0)
    fmt::print(out, "rays         {}{}\n", report.rays,
               asked == FactorMethod::automatic
                   ? ", a fraction of the work that exact pairs are (--method exact)"
                   : "");
  else if (report.clear_pairs + report.partial_pairs > 0)
    fmt::print(out, "pairs        {} clear, {} with something between\n", report.clear_pairs,
               report.partial_pairs);
  fmt::print(out, "error        at most {:.2g} in a factor; rows sum to 1 within {:.2g}\n",
             matrix.error.maxCoeff(), report.row_sum_error_max);
  if (report.left_out > 0)
    fmt::print(out, "left out     {} factors, {:.2g} of a row at most\n", report.left_out,
               report.left_out_max);
  if (report.is_enforced)
    fmt::print(out, "enforced     factors changed by up to {:.2g} %\n", 100 * report.enforced_by);
}

/// What to do about rows that are not exact enough, or what tells that they are not.
const char* remedy(const FactorReport& report, double tolerance) {
  if (report.pairs_at_limit > 0) return ", and allow more with --max-points";
  if (report.method == FactorMethod::rays) return ", and ask for more with --rays";
  return report.row_sum_error_max > tolerance ? ": sums of rows tell it" : "";
}

/// Why the matrix is not what was asked for; empty if it is.
std::string not_reached(const FactorMatrix& matrix, const FactorOptions& options) {
  if (options.enforce && !matrix.report.is_enforced)
    return "no scaling makes rows sum to one; they are as they were computed";
  if (matrix.report.rows_not_reached > 0)
    return fmt::format(
        "{} of {} rows have form factors whose error is up to {:.2g}, and {:.2g} was asked for; "
        "see 'error'{}",
        matrix.report.rows_not_reached, matrix.names.size(), matrix.error.maxCoeff(),
        options.tolerance, remedy(matrix.report, options.tolerance));
  return {};
}

}  // namespace

ExitCode run(const FactorsCommand& command, const Context& context) {
  const CommandFiles files = checked_files(command, context.common);
  const SceneFile file =
      read_scene(command.scene, command.materials, context.common.orientation, files);
  const FactorMatrix matrix =
      command.from.empty()
          ? form_factor_matrix(file.scene, command.options, context.progress)
          : summed_factors(file.scene, read_factors(command.from), command.options);
  context.progress_ends();
  if (!matrix.report.is_complete) return end_without_results();
  const std::string sentence = not_reached(matrix, command.options);
  const ExitCode code = sentence.empty() ? exit_done : exit_not_accurate;
  const auto outputs = factor_files(command.output);
  write_factors(matrix, context.provenance, command.output);
  if (!context.common.json.empty())
    write_report(matrix, run_info(context, code, outputs), context.common.json);
  print_doubts(file, matrix, command.options.unit, context);
  if (!context.common.quiet) {
    print_summary(matrix, command.options.method, context);
    print_outputs(context, outputs);
  }
  if (!sentence.empty()) complain("{}\n", sentence);
  return code;
}

}  // namespace halfshade
