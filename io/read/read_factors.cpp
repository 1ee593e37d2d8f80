// Form factors as MatrixMarket coordinates (Boisvert, Pozo, Remington, Barrett and Dongarra 1997),
// and the table beside them.

#include "io/read/read_factors.h"

#include "io/files/extension.h"
#include "io/read/read_text.h"
#include "meshing/core/error.h"
#include "solver/factors/saved_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace halfshade {
namespace {

using namespace reading;
using std::filesystem::path;

/// The cells of a line of a table (RFC 4180).
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (is_quoted && c == '"' && k + 1 < line.size() && line[k + 1] == '"')
      cells.back() += line[++k];
    else if (c == '"')
      is_quoted = !is_quoted;
    else if (c == ',' && !is_quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

/// A number of the table; `least` and `most` are what it may be.
double number_in(const std::string& cell, const char* what, double least, double most,
                 const path& file, int line) {
  const double value = number(cell, file, line);
  if (!(value >= least && value <= most && std::isfinite(value)))
    fail(file, line, fmt::format("{} is {}; it must lie in [{}, {}]", what, value, least, most));
  return value;
}

/// Estimates of shares may be off by what they are.
constexpr double least_share = -0.5, most_share = 1.5;

/// The table beside a matrix, by the names of its columns.
class NamesReader {
 public:
  NamesReader(const path& file, FactorMatrix& matrix)
      : file_(file), bytes_(read_bytes(file)), lines_(bytes_), matrix_(matrix) {}

  void read() {
    constexpr std::string_view needed = "surface,area,space,row_sum,error";
    if (!lines_.next() || !lines_.text().starts_with(needed))
      fail(file_, lines_.line(),
           fmt::format("this is no table of form factors: '{}' is expected here", needed));
    columns_ = cells_of(lines_.text());
    while (lines_.next()) row();
    if (matrix_.names.empty()) fail(file_, 0, "the table has no rows");
    matrix_.area = values("area");
    matrix_.space = values("space");
    matrix_.row_sum = values("row_sum");
    matrix_.error = values("error");
    if (has("left_out")) matrix_.left_out = values("left_out");
    if (std::all_of(place_columns.begin(), place_columns.end(),
                    [&](std::string_view name) { return has(name); }))
      read_places();
    matrix_.backs = Eigen::ArrayXd::Zero(matrix_.area.size());
    matrix_.report.row_sum_error_max = (matrix_.row_sum - 1).abs().maxCoeff();
  }

 private:
  void row() {
    const std::vector<std::string> cells = cells_of(lines_.text());
    if (cells.size() != columns_.size())
      fail(file_, lines_.line(),
           fmt::format("there are {} cells; {} are expected", cells.size(), columns_.size()));
    matrix_.names.push_back(cells[0]);
    for (std::size_t k = 1; k < cells.size(); ++k)
      if (const std::optional<double> value = value_of(columns_[k], cells[k]))
        values_[columns_[k]].push_back(*value);
  }

  /// Nothing in a column that is not known.
  std::optional<double> value_of(const std::string& column, const std::string& text) const {
    const auto within = [&](const char* what, double least, double most) {
      return number_in(text, what, least, most, file_, lines_.line());
    };
    if (column == "space") return within("space", least_share, most_share);
    if (column == "row_sum") return within("a row's sum", least_share, HUGE_VAL);
    if (column == "error") return within("an error", 0, HUGE_VAL);
    if (column == "left_out") return within("what was left out", 0, most_share);
    if (std::find(place_columns.begin(), place_columns.end(), column) != place_columns.end())
      return within("a place", -HUGE_VAL, HUGE_VAL);
    if (column != "area") return std::nullopt;
    const double area = within("an area", 0, HUGE_VAL);
    if (!(area > 0)) fail(file_, lines_.line(), "an area is 0");
    return area;
  }

  bool has(std::string_view column) const { return values_.contains(std::string(column)); }

  Eigen::ArrayXd values(std::string_view column) {
    std::vector<double>& found = values_[std::string(column)];
    if (found.size() != matrix_.names.size())
      fail(file_, 0, fmt::format("the column {} is there twice", in_quotes(column)));
    return Eigen::Map<Eigen::ArrayXd>(found.data(), static_cast<Eigen::Index>(found.size()));
  }

  void read_places() {
    const auto vectors = [&](std::size_t first) {
      Eigen::Matrix3Xd result(3, matrix_.area.size());
      for (std::size_t k = 0; k < 3; ++k)
        result.row(static_cast<Eigen::Index>(k)) =
            values(place_columns[first + k]).matrix().transpose();
      return result;
    };
    const Eigen::Matrix3Xd centre = vectors(0), normal = vectors(3), extent = vectors(6);
    for (Eigen::Index i = 0; i < matrix_.area.size(); ++i)
      matrix_.places.push_back({centre.col(i), normal.col(i), extent.col(i)});
  }

  path file_;
  std::string bytes_;
  LineReader lines_;
  FactorMatrix& matrix_;
  std::vector<std::string> columns_;
  std::map<std::string, std::vector<double>> values_;  ///< by column, one a row
};

class MatrixReader {
 public:
  MatrixReader(const path& file, FactorMatrix& matrix)
      : file_(file), bytes_(read_bytes(file)), lines_(bytes_), matrix_(matrix) {}

  void read() {
    if (!lines_.next() || lower(lines_.text()) != "%%matrixmarket matrix coordinate real general")
      fail(file_, lines_.line(),
           "this is no matrix of form factors: '%%MatrixMarket matrix coordinate real general' is "
           "expected here");
    next("its size");
    const auto rows = static_cast<long long>(matrix_.names.size());
    if (whole(0) != rows || whole(1) != rows)
      fail(file_, lines_.line(),
           fmt::format("the matrix is {} by {}, but {} has {} rows", words_[0], words_[1],
                       factor_names_file(file_).string(), rows));
    require_factor_memory(static_cast<int>(rows));
    matrix_.factors = RowMajorMatrix::Zero(rows, rows);
    for (long long n = whole(2); n > 0; --n) {
      next("all entries are there");
      entry(rows);
    }
    if (lines_.next()) fail(file_, lines_.line(), "there are more entries than the size says");
  }

 private:
  /// The next line that is no comment, in three words.
  void next(const char* what) {
    do {
      if (!lines_.next()) fail(file_, 0, fmt::format("the file ends before {}", what));
    } while (lines_.text().starts_with('%'));
    split(lines_.text(), words_);
    if (words_.size() != 3)
      fail(file_, lines_.line(), fmt::format("there are {} words; 3 are expected", words_.size()));
  }

  long long whole(std::size_t word) const {
    const std::optional<long long> value = parse_integer(words_[word]);
    if (!value || *value < 0)
      fail(file_, lines_.line(),
           fmt::format("{} is not a number of a row", in_quotes(words_[word])));
    return *value;
  }

  void entry(long long rows) {
    const long long i = whole(0), j = whole(1);
    if (i < 1 || i > rows || j < 1 || j > rows)
      fail(file_, lines_.line(),
           fmt::format("the entry ({}, {}) is out of the matrix of {} rows", i, j, rows));
    double& value = matrix_.factors(i - 1, j - 1);
    if (value != 0)
      fail(file_, lines_.line(), fmt::format("the entry ({}, {}) is there twice", i, j));
    value = number_in(std::string(words_[2]), "a form factor", least_share, most_share, file_,
                      lines_.line());
  }

  path file_;
  std::string bytes_;
  LineReader lines_;
  FactorMatrix& matrix_;
  std::vector<std::string_view> words_;
};

}  // namespace

path factor_names_file(const path& file) { return path(file).replace_extension(".names.csv"); }

FactorMatrix read_factors(const path& file) {
  if (extension_of(file) != ".mtx")
    throw Error(ErrorCode::usage, file.string(),
                "form factors are read from a .mtx file, with its .names.csv beside it");
  FactorMatrix matrix;
  matrix.source = file.string();
  // A matrix without its table helps nobody; the sentence names what is missing.
  require_readable(file);
  NamesReader(factor_names_file(file), matrix).read();
  MatrixReader(file, matrix).read();
  require_rows_that_add_up(matrix);
  return matrix;
}

}  // namespace halfshade
