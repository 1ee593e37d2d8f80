#include "io/study/study_table.h"

#include "io/files/atomic_file.h"
#include "io/read/read_text.h"
#include "meshing/core/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 4> end_names = {"done", "not_accurate", "time_limit", "failed"};

const std::vector<std::string>& columns() {
  static const std::vector<std::string> names = {"method",
                                                 "tolerance",
                                                 "status",
                                                 "seconds",
                                                 "cpu_seconds",
                                                 "process_seconds",
                                                 "peak_memory_bytes",
                                                 "elements",
                                                 "unknowns",
                                                 "estimated_error",
                                                 "error",
                                                 "max_error",
                                                 "direct_error",
                                                 "direct_max_error",
                                                 "reflected_error",
                                                 "reflected_max_error",
                                                 "effectivity",
                                                 "stages",
                                                 "note"};
  return names;
}

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

/// A text that separates no cells and begins no comment.
std::string cell(std::string text) {
  for (char& c : text) {
    if (c == ',') c = ';';
    if (c == '\n' || c == '\r' || c == '#') c = ' ';
  }
  return text;
}

std::vector<std::string> cells_of(const StudyRow& row) {
  return {row.one.method,
          fmt::format("{}", row.one.tolerance),
          end_names.at(static_cast<std::size_t>(row.end)),
          cell(row.seconds),
          cell(row.cpu_seconds),
          cell(row.process_seconds),
          fmt::format("{}", row.peak_memory_bytes),
          fmt::format("{}", row.elements),
          fmt::format("{}", row.unknowns),
          cell(row.estimated),
          cell(row.total.l2),
          cell(row.total.max),
          cell(row.direct.l2),
          cell(row.direct.max),
          cell(row.reflected.l2),
          cell(row.reflected.max),
          cell(row.effectivity()),
          cell(row.stages),
          cell(row.note)};
}

StudyRow row_of(const std::vector<std::string>& cells, const fs::path& path) {
  const auto number = [&](std::size_t k) { return number_in(cells[k], path); };
  const auto count = [&](std::size_t k) {
    const double value = number(k);
    if (!(value >= 0)) reading::fail(path, 0, fmt::format("'{}' is no number", cells[k]));
    return static_cast<std::size_t>(value);
  };
  const auto end = std::find(end_names.begin(), end_names.end(), cells[2]);
  if (end == end_names.end())
    reading::fail(path, 0, fmt::format("'{}' is no status of a case", cells[2]));
  StudyRow row;
  row.one = {cells[0], number(1)};
  row.end = static_cast<CaseEnd>(end - end_names.begin());
  row.seconds = number(3);
  row.cpu_seconds = number(4);
  row.process_seconds = number(5);
  row.peak_memory_bytes = count(6);
  row.elements = count(7);
  row.unknowns = count(8);
  row.estimated = number(9);
  row.total = {number(10), number(11)};
  row.direct = {number(12), number(13)};
  row.reflected = {number(14), number(15)};
  row.stages = cells[17];
  row.note = cells[18];
  return row;
}

std::vector<std::string> split_at_commas(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::size_t place_of_method(const std::string& name) {
  const auto& all = study_methods();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const StudyMethod& method) { return method.name == name; });
  return static_cast<std::size_t>(found - all.begin());
}

constexpr const char* what_columns_mean =
    "# seconds and cpu_seconds: of the stages of solve, each in `stages` as name wall/cpu;\n"
    "# process_seconds and peak_memory_bytes: of the whole run, with reading and writing\n"
    "# elements: of the result and of reflected light's own mesh; unknowns: of a channel\n"
    "# error: L2 of the irradiance, max_error: the largest, both relative to the root of the mean\n"
    "# square of all irradiance at the points; the same of direct and reflected light alone\n"
    "# effectivity: estimated_error / error\n";

}  // namespace

bool has_result(const StudyRow& row) { return std::isfinite(row.total.l2); }

double number_in(const std::string& cell, const fs::path& path) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  return reading::finite_number(cell, path, 0);
}

TextTable read_table(const fs::path& path) {
  const std::string bytes = reading::read_bytes(path);
  TextTable table;
  if (bytes.starts_with("# ")) table.comment = bytes.substr(2, bytes.find('\n') - 2);
  reading::LineReader lines(bytes);
  while (lines.next()) {
    std::vector<std::string> cells = split_at_commas(lines.text());
    if (table.header.empty())
      table.header = std::move(cells);
    else if (cells.size() == table.header.size())
      table.rows.push_back(std::move(cells));
    else
      reading::fail(path, lines.line(),
                    fmt::format("this row has {} cells, but the first has {}", cells.size(),
                                table.header.size()));
  }
  return table;
}

void require_key(const TextTable& table, const std::string& key, const fs::path& path) {
  if (table.comment == key) return;
  throw Error(ErrorCode::usage, path.string(),
              "this is of another study (another scene, other points or samples); name another "
              "folder");
}

void write_study(const std::vector<StudyRow>& rows, const std::string& key, const fs::path& path) {
  std::vector<StudyRow> sorted = rows;
  std::stable_sort(sorted.begin(), sorted.end(), [](const StudyRow& a, const StudyRow& b) {
    return std::pair(place_of_method(a.one.method), -a.one.tolerance) <
           std::pair(place_of_method(b.one.method), -b.one.tolerance);
  });
  std::string bytes =
      fmt::format("# {}\n{}{}\n", key, what_columns_mean, fmt::join(columns(), ","));
  for (const StudyRow& row : sorted) bytes += fmt::format("{}\n", fmt::join(cells_of(row), ","));
  write_atomically(path, bytes);
}

std::vector<StudyRow> read_study(const std::string& key, const fs::path& path) {
  const TextTable table = read_table(path);
  require_key(table, key, path);
  if (table.header != columns())
    reading::fail(path, 0, "this is no table of a study: its columns have other names");
  std::vector<StudyRow> rows;
  for (const auto& cells : table.rows) rows.push_back(row_of(cells, path));
  return rows;
}

}  // namespace halfshade
