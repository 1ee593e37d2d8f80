#include "io/study/study_run.h"

#include "io/read/read_text.h"
#include "io/study/child_process.h"
#include "meshing/core/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace halfshade {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int exit_not_accurate = 4;

fs::path case_file(const StudyCase& one, const StudyOptions& options, const std::string& end) {
  return options.folder / "cases" / (name_of(one) + end);
}

/// What a run said last.
std::string last_line(const fs::path& log) {
  std::ifstream stream(log);
  std::string last, line;
  while (std::getline(stream, line))
    if (!line.empty()) last = line;
  return last;
}

void fill_from_report(const fs::path& path, StudyRow& row) {
  try {
    const Json report = Json::parse(reading::read_bytes(path));
    row.elements = report.at("mesh").at("elements");
    row.unknowns = report.at("radiosity").at("unknowns");
    if (report.contains("direct_light")) {
      row.unknowns = report.at("direct_light").at("unknowns");
      const Json& reflected = report.at("reflected_light");
      row.elements += reflected.at("elements").get<std::size_t>();
      if (reflected.contains("unknowns"))
        row.unknowns += reflected.at("unknowns").get<std::size_t>();
    } else {
      row.unknowns = row.elements;
    }
    row.estimated = report.at("estimated_relative_error");
    for (const Json& stage : report.at("stages")) {
      if (!stage.at("left_out_because").is_null()) continue;
      const double wall = stage.at("seconds"), cpu = stage.at("cpu_seconds");
      row.seconds += wall;
      row.cpu_seconds += cpu;
      row.stages += fmt::format("{}{} {:.3g}/{:.3g}", row.stages.empty() ? "" : "; ",
                                stage.at("name").get<std::string>(), wall, cpu);
    }
  } catch (const Json::exception& e) {
    throw Error(ErrorCode::invalid_input, path.string(),
                fmt::format("the report of a case cannot be read ({})", e.what()));
  }
}

}  // namespace

fs::path result_of(const StudyCase& one, const StudyOptions& options) {
  return case_file(one, options, ".vtu");
}

void keep_finest_results(const std::vector<StudyRow>& rows, const StudyOptions& options) {
  for (const StudyRow& row : rows)
    if (std::any_of(rows.begin(), rows.end(), [&](const StudyRow& other) {
          return other.one.method == row.one.method && has_result(other) &&
                 other.one.tolerance < row.one.tolerance;
        }))
      fs::remove(result_of(row.one, options));
}

std::vector<std::string> case_command(const StudyCase& one, const StudyOptions& options) {
  std::vector<std::string> words = options.solve;
  const auto method = study_method(one.method).options(one.tolerance);
  words.insert(words.end(), method.begin(), method.end());
  const auto file = [&](const char* end) { return case_file(one, options, end).string(); };
  const std::vector<std::string> files = {"--points", (options.folder / "points.csv").string(),
                                          "--values", file(".csv"),
                                          "-o",       file(".vtu"),
                                          "--json",   file(".json"),
                                          "--quiet"};
  words.insert(words.end(), files.begin(), files.end());
  return words;
}

std::optional<StudyRow> run_case(const StudyCase& one, const StudyOptions& options,
                                 const StudyReference& reference, const std::stop_token& stop) {
  const fs::path log = case_file(one, options, ".log");
  const ChildEnd end = run_child(case_command(one, options), {log, options.time_limit}, stop);
  if (end.stopped) return std::nullopt;
  StudyRow row;
  row.one = one;
  row.process_seconds = end.seconds;
  row.peak_memory_bytes = end.peak_memory_bytes;
  const bool has_ended = end.exit_code == 0 || end.exit_code == exit_not_accurate;
  if (end.timed_out || !has_ended) {
    row.end = end.timed_out ? CaseEnd::time_limit : CaseEnd::failed;
    row.seconds = end.seconds;
    row.cpu_seconds = end.cpu_seconds;
    row.note = end.timed_out ? fmt::format("ended after {:.0f} s", options.time_limit)
                             : fmt::format("exit code {}: {}", end.exit_code, last_line(log));
    return row;
  }
  row.end = end.exit_code == 0 ? CaseEnd::done : CaseEnd::not_accurate;
  if (row.end == CaseEnd::not_accurate) row.note = last_line(log);
  fill_from_report(case_file(one, options, ".json"), row);
  const StudyValues values = read_values(case_file(one, options, ".csv"));
  if (values.irradiance.size() != reference.direct.size())
    throw Error(ErrorCode::invalid_input, case_file(one, options, ".csv").string(),
                fmt::format("there are {} values for {} points", values.irradiance.size(),
                            reference.direct.size()));
  fill_errors(reference, values, row);
  return row;
}

}  // namespace halfshade
