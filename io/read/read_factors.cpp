// Form factors as MatrixMarket coordinates (Boisvert, Pozo, Remington, Barrett and Dongarra 1997),
// and the table beside them.

#include "io/read/read_factors.h"

#include "io/files/extension.h"
#include "io/read/read_text.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

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

void read_names(const path& file, FactorMatrix& matrix) {
  const std::string bytes = read_bytes(file);
  LineReader lines(bytes);
  if (!lines.next() || lines.text() != "surface,area,space,row_sum,error")
    fail(file, lines.line(),
         "this is no table of form factors: 'surface,area,space,row_sum,error' is expected here");
  std::vector<std::array<double, 4>> rows;
  while (lines.next()) {
    const std::vector<std::string> cells = cells_of(lines.text());
    if (cells.size() != 5)
      fail(file, lines.line(), fmt::format("there are {} cells; 5 are expected", cells.size()));
    matrix.names.push_back(cells[0]);
    rows.push_back({number_in(cells[1], "an area", 0, HUGE_VAL, file, lines.line()),
                    number_in(cells[2], "space", least_share, most_share, file, lines.line()),
                    number_in(cells[3], "a row's sum", least_share, HUGE_VAL, file, lines.line()),
                    number_in(cells[4], "an error", 0, HUGE_VAL, file, lines.line())});
    if (!(rows.back()[0] > 0)) fail(file, lines.line(), "an area is 0");
  }
  if (rows.empty()) fail(file, 0, "the table has no rows");
  const auto column = [&rows](std::size_t k) {
    Eigen::ArrayXd values(static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) values[static_cast<Eigen::Index>(i)] = rows[i][k];
    return values;
  };
  matrix.area = column(0);
  matrix.space = column(1);
  matrix.row_sum = column(2);
  matrix.error = column(3);
  matrix.backs = Eigen::ArrayXd::Zero(matrix.area.size());
  matrix.report.row_sum_error_max = (matrix.row_sum - 1).abs().maxCoeff();
}

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
  read_names(factor_names_file(file), matrix);
  MatrixReader(file, matrix).read();
  return matrix;
}

}  // namespace halfshade
