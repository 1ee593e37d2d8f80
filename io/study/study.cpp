#include "io/study/study.h"

#include "io/read/read_text.h"
#include "io/study/study_run.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t usual_methods = 6;
constexpr double usual_tolerances[] = {0.1, 0.03, 0.01, 0.003, 0.001, 3e-4, 1e-4};
/// A case takes about so many times as long as the one before it.
constexpr double usual_growth = 3;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "cases", error);
  if (error)
    throw Error(ErrorCode::unwritable, folder.string(),
                fmt::format("the folder cannot be made ({})", error.message()));
}

const StudyRow* find(const std::vector<StudyRow>& rows, const StudyCase& one) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const StudyRow& row) { return row.one == one; });
  return found == rows.end() ? nullptr : &*found;
}

bool took_too_long(const StudyRow& row, double limit) {
  return row.end == CaseEnd::time_limit && row.process_seconds >= limit;
}

/// Whether a case need not be run: it is done, or a coarser one of its method took too long.
bool is_settled(const StudyCase& one, const std::vector<StudyRow>& rows, double limit) {
  if (const StudyRow* row = find(rows, one); row && row->end != CaseEnd::time_limit) return true;
  return std::any_of(rows.begin(), rows.end(), [&](const StudyRow& row) {
    return row.one.method == one.method && row.one.tolerance >= one.tolerance &&
           took_too_long(row, limit);
  });
}

/// About how long the cases that are left will take.
double seconds_left(std::span<const StudyCase> cases, const std::vector<StudyRow>& rows,
                    double limit) {
  double sum = 0;
  std::vector<StudyRow> imagined = rows;
  for (const StudyCase& one : cases) {
    if (is_settled(one, imagined, limit)) continue;
    double before = limit / 100;
    for (const StudyRow& row : imagined)
      if (row.one.method == one.method) before = std::max(before, row.process_seconds);
    StudyRow& row = imagined.emplace_back();
    row.one = one;
    row.process_seconds = std::min(limit, usual_growth * before);
    if (row.process_seconds >= limit) row.end = CaseEnd::time_limit;
    sum += row.process_seconds;
  }
  return sum;
}

std::optional<StudyReference> get_reference(const PreparedScene& prepared,
                                            const StudyOptions& options, const Progress& progress) {
  const fs::path path = study_file(options, "reference.csv");
  if (fs::exists(path)) return read_reference(options.key, path);
  std::optional<StudyReference> found = find_reference(prepared, options.reference, progress);
  if (found) write_reference(*found, options.key, path);
  return found;
}

}  // namespace

fs::path study_file(const StudyOptions& options, const std::string& name) {
  return options.folder / name;
}

std::vector<StudyCase> study_cases(const StudyOptions& options) {
  std::vector<std::string> methods = options.methods;
  for (std::size_t k = 0; options.methods.empty() && k < usual_methods; ++k)
    methods.emplace_back(study_methods()[k].name);
  std::vector<double> tolerances = options.tolerances;
  if (tolerances.empty())
    tolerances.assign(std::begin(usual_tolerances), std::end(usual_tolerances));
  std::sort(tolerances.begin(), tolerances.end(), std::greater<>());
  tolerances.erase(std::unique(tolerances.begin(), tolerances.end()), tolerances.end());
  std::vector<StudyCase> cases;
  for (const double tolerance : tolerances)
    for (const std::string& method : methods)
      if (const StudyCase one{method, tolerance};
          !study_method(method).options(tolerance).empty() &&
          std::find(cases.begin(), cases.end(), one) == cases.end())
        cases.push_back(one);
  return cases;
}

std::optional<Study> run_study(const PreparedScene& prepared, const StudyOptions& options,
                               const Progress& progress,
                               const std::function<void(const StudyRow&)>& tell) {
  make_folder(options.folder);
  const fs::path table = study_file(options, "study.csv");
  Study study;
  if (fs::exists(table)) study.rows = read_study(options.key, table);
  std::optional<StudyReference> reference = get_reference(prepared, options, progress);
  if (!reference) return std::nullopt;
  study.reference = std::move(*reference);
  write_places(study.reference, study_file(options, "points.csv"));
  const std::vector<StudyCase> cases = study_cases(options);
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (is_settled(cases[k], study.rows, options.time_limit)) continue;
    const double left = seconds_left(std::span(cases).subspan(k), study.rows, options.time_limit);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    progress("study", elapsed.count() / (elapsed.count() + left));
    const std::optional<StudyRow> row = run_case(cases[k], options, study.reference, progress.stop);
    if (!row) {
      study.complete = false;
      break;
    }
    std::erase_if(study.rows, [&](const StudyRow& old) { return old.one == cases[k]; });
    study.rows.push_back(*row);
    write_study(study.rows, options.key, table);
    keep_finest_results(study.rows, options);
    tell(*row);
  }
  if (study.rows.empty()) return std::nullopt;
  study.rows = read_study(options.key, table);  // sorted
  return study;
}

}  // namespace halfshade
