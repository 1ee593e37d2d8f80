#include "apps/command_files.h"
#include "apps/console.h"
#include "apps/run_end.h"
#include "io/files/atomic_file.h"
#include "io/files/seal.h"
#include "io/read/read_text.h"
#include "io/study/child_process.h"
#include "io/study/study_page.h"
#include "solver/pipeline/prepared_scene.h"

#include <fmt/format.h>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

/// What every case begins with.
std::vector<std::string> solve_words(const StudyCommand& command, const CommonOptions& common) {
  std::vector<std::string> words = {this_program().string(), "solve", command.scene.string()};
  if (!command.materials.empty())
    words.insert(words.end(), {"--materials", command.materials.string()});
  if (common.orientation.flip) words.emplace_back("--flip");
  if (common.orientation.orient) words.emplace_back("--orient");
  if (command.options.reference.direct_only) words.insert(words.end(), {"--bounces", "0"});
  if (common.threads > 0)
    words.insert(words.end(), {"--threads", fmt::format("{}", common.threads)});
  return words;
}

/// Studies with the same key can go on as one: the same bytes of the scene and all it names, the
/// same points and samples.
std::string study_key(const StudyCommand& command, const SceneFile& file,
                      const CommonOptions& common) {
  std::vector<fs::path> files = file.files;
  files.push_back(command.scene);
  if (!command.materials.empty()) files.push_back(command.materials);
  if (const fs::path sidecar = fs::path(command.scene).replace_extension(".json");
      fs::exists(sidecar))
    files.push_back(sidecar);
  std::string sums;
  for (const fs::path& path : files)
    sums += fmt::format("{:016x} ", detail::checksum(reading::read_bytes(path)));
  const StudyReferenceOptions& reference = command.options.reference;
  return fmt::format(
      "halfshade study of {}, {:016x}: {} points, {}{}{}", command.scene.filename().string(),
      detail::checksum(sums), reference.points,
      reference.direct_only ? "direct light" : fmt::format("{} samples", reference.samples),
      common.orientation.flip ? ", flipped" : "", common.orientation.orient ? ", oriented" : "");
}

void print_row(const StudyRow& row, const Context& context) {
  if (context.common.quiet) return;
  context.progress_ends();
  const std::string head = fmt::format("{:<17} {:<7g}", row.one.method, row.one.tolerance);
  if (has_result(row))
    fmt::print(context.summary, "{} {:>9.3f} s   error {:.2e}   estimated {:.2e}\n", head,
               row.seconds, row.total.l2, row.estimated);
  else
    fmt::print(context.summary, "{} {}\n", head, row.note);
  std::fflush(context.summary);
}

std::vector<fs::path> write_study_files(const Study& study, const StudyOptions& options,
                                        const StudyPageInfo& info) {
  std::vector<fs::path> written = {study_file(options, "study.html"),
                                   study_file(options, "study.csv")};
  for (const StudyChart& chart : study_charts(study, info.scene))
    for (const char* extension : {".svg", ".png"}) {
      written.push_back(study_file(options, chart.name + extension));
      write_chart(chart.chart, written.back());
    }
  write_atomically(written.front(), study_page(study, options, info));
  return written;
}

/// Throws Error(usage) if the report would be one of the files that a study makes in its folder.
void require_own_report(const fs::path& report, const fs::path& folder) {
  std::error_code error;
  const bool is_inside =
      !report.empty() && fs::weakly_canonical(report, error).parent_path() ==
                             fs::weakly_canonical(folder / "study.csv", error).parent_path();
  if (is_inside && report.extension() != ".json")
    throw Error(ErrorCode::usage, report.string(),
                "a report in the study's folder may be one of the study's files; let its name end "
                "in .json");
}

}  // namespace

ExitCode run(const StudyCommand& command, const Context& context) {
  CommandFiles files = scene_files(command.scene, command.materials, context.common);
  for (const char* name : {"study.html", "study.csv", "reference.csv", "points.csv"})
    add_outputs(files, "-o", {study_file(command.options, name)});
  require_apart(files);
  require_own_report(context.common.json, command.options.folder);
  require_place(context.common.json);
  const SceneFile file = read_scene(command.scene, command.materials, context.common.orientation,
                                    files, exact_lamp_tolerance);
  require_three_channels(file, "study");
  const PreparedScene prepared(file.scene, context.progress);
  StudyOptions options = command.options;
  options.solve = solve_words(command, context.common);
  options.key = study_key(command, file, context.common);
  print_warnings(file, prepared.warnings(), context);
  const std::optional<Study> study = run_study(
      prepared, options, context.progress, [&](const StudyRow& row) { print_row(row, context); });
  context.progress_ends();
  if (!study) return end_without_results();
  const std::vector<fs::path> written =
      write_study_files(*study, options,
                        {command.scene.filename().string(), context.provenance.version,
                         context.provenance.command_line});
  const ExitCode code = study->complete ? exit_done : exit_interrupted;
  if (!context.common.json.empty())
    write_report(StudyReport{study->rows.size(), study->complete}, run_info(context, code, written),
                 context.common.json);
  if (!context.common.quiet) print_outputs(context, {written.front(), written.at(1)});
  if (code == exit_interrupted)
    complain("interrupted: what is done is written; the same command goes on\n");
  return code;
}

}  // namespace halfshade
