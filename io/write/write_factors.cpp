#include "io/write/write_factors.h"

#include "io/files/atomic_file.h"
#include "io/files/same_file.h"
#include "io/read/read_factors.h"
#include "io/write/report_parts.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <iterator>
#include <string>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

/// A cell of a table (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n#") == std::string::npos) return text;
  std::string quoted(1, '"');
  for (const char c : text) {
    if (c == '"') quoted += c;
    quoted += c;
  }
  return quoted += '"';
}

/// Of one line, whatever the command line has in it.
std::string comment_of(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

std::string comments(const FactorMatrix& matrix, const Provenance& provenance, char mark) {
  const FactorReport& report = matrix.report;
  std::string text =
      fmt::format("{0} halfshade {1}\n{0} {2}\n{0} areas in {3}²\n", mark, provenance.version,
                  comment_of(provenance.command_line), comment_of(matrix.unit));
  if (report.left_out > 0)
    text += fmt::format(
        "{} {} form factors that cannot reach {} are left out, {:.2g} of a row at "
        "most\n",
        mark, report.left_out, report.sparse_below, report.left_out_max);
  if (report.is_enforced)
    text += fmt::format(
        "{} scaled until rows, with space, sum to one; row_sum is what they were before\n", mark);
  return text;
}

void add_number(std::string& bytes, double value) {
  fmt::format_to(std::back_inserter(bytes), ",{:.17g}", value);
}

void add_vector(std::string& bytes, const Vec3& values) {
  for (const double value : values) add_number(bytes, value);
}

/// The first two columns, and the last three.
void add_begin(std::string& bytes, const FactorMatrix& matrix, Eigen::Index row) {
  bytes += cell(matrix.names[static_cast<std::size_t>(row)]);
  add_number(bytes, matrix.area[row]);
}

void add_end(std::string& bytes, const FactorMatrix& matrix, Eigen::Index row) {
  add_number(bytes, matrix.space[row]);
  add_number(bytes, matrix.row_sum[row]);
  add_number(bytes, matrix.error[row]);
}

std::string table_bytes(const FactorMatrix& matrix, const Provenance& provenance) {
  std::string bytes = comments(matrix, provenance, '#') + "surface,area";
  for (const std::string& name : matrix.names) (bytes += ',') += cell(name);
  bytes += ",space,row_sum,error\n";
  for (Eigen::Index i = 0; i < matrix.area.size(); ++i) {
    add_begin(bytes, matrix, i);
    for (Eigen::Index j = 0; j < matrix.area.size(); ++j) add_number(bytes, matrix.factors(i, j));
    add_end(bytes, matrix, i);
    bytes += '\n';
  }
  return bytes;
}

/// What tells to which scene a matrix belongs, and whether it is whole.
std::string names_bytes(const FactorMatrix& matrix, const Provenance& provenance) {
  std::string bytes =
      comments(matrix, provenance, '#') + "surface,area,space,row_sum,error,left_out";
  if (!matrix.places.empty())
    for (const std::string_view column : place_columns) (bytes += ',') += column;
  bytes += '\n';
  for (Eigen::Index i = 0; i < matrix.area.size(); ++i) {
    add_begin(bytes, matrix, i);
    add_end(bytes, matrix, i);
    add_number(bytes, matrix.left_out[i]);
    if (!matrix.places.empty()) {
      const RowPlace& place = matrix.places[static_cast<std::size_t>(i)];
      for (const Vec3& values : {place.centre, place.normal, place.extent})
        add_vector(bytes, values);
    }
    bytes += '\n';
  }
  return bytes;
}

std::string matrix_market_bytes(const FactorMatrix& matrix, const Provenance& provenance) {
  const Eigen::Index count = matrix.area.size();
  std::string bytes =
      "%%MatrixMarket matrix coordinate real general\n" + comments(matrix, provenance, '%') +
      fmt::format("{} {} {}\n", count, count, (matrix.factors.array() != 0).count());
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      if (matrix.factors(i, j) != 0)
        fmt::format_to(std::back_inserter(bytes), "{} {} {:.17g}\n", i + 1, j + 1,
                       matrix.factors(i, j));
  return bytes;
}

}  // namespace

std::vector<fs::path> factor_files(const fs::path& path) {
  if (is_standard_stream(path) || extension_of(path) != ".mtx") return {path};
  return {path, factor_names_file(path)};
}

void write_factors(const FactorMatrix& matrix, const Provenance& provenance, const fs::path& path) {
  if (!is_standard_stream(path)) require_format(path, factor_formats);
  const std::vector<fs::path> files = factor_files(path);
  if (files.size() == 1) return write_atomically(path, table_bytes(matrix, provenance));
  const std::array<FileBytes, 2> both = {{{files[0], matrix_market_bytes(matrix, provenance)},
                                          {files[1], names_bytes(matrix, provenance)}}};
  write_together(both);
}

void write_report(const FactorMatrix& matrix, const RunInfo& run, const fs::path& path) {
  const FactorReport& report = matrix.report;
  detail::Json json = detail::head_json(run);
  json["unit"] = matrix.unit;
  json["surfaces"] = matrix.names.size();
  json["method"] = name_of(report.method);
  json["clear_pairs"] = report.clear_pairs;
  json["partial_pairs"] = report.partial_pairs;
  json["points"] = report.points;
  json["rays"] = report.rays;
  json["rows_not_reached"] = report.rows_not_reached;
  json["row_sum_error_max"] = report.row_sum_error_max;
  json["error_max"] = matrix.error.maxCoeff();
  json["backs_max"] = report.backs_max;
  json["left_out"] = report.left_out;
  json["left_out_max"] = report.left_out_max;
  json["enforced_by"] = nullptr;
  if (report.is_enforced) json["enforced_by"] = report.enforced_by;
  json["repairs"] = detail::repairs_json(matrix.scene);
  json["interrupted"] = !report.is_complete;
  json["outputs"] = detail::Json::array();
  for (const fs::path& output : run.outputs) json["outputs"].push_back(output.string());
  // Names from files may be in any encoding.
  write_atomically(path, json.dump(2, ' ', false, detail::Json::error_handler_t::replace) + "\n");
}

}  // namespace halfshade
