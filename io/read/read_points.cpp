#include "io/read/read_points.h"

#include "io/files/same_file.h"
#include "io/read/read_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {
namespace {

// How far from 1 the length of a normal that was normalised may be.
constexpr double rounding = 1e-15;

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> names = {"x", "y", "z", "nx", "ny", "nz"};
constexpr const char* standard_header = "x,y,z,nx,ny,nz";

/// Which column holds each of `names`.
using Columns = std::array<std::size_t, 6>;

char separator_of(std::string_view row) {
  for (const char c : {',', ';', '\t'})
    if (row.find(c) != std::string_view::npos) return c;
  return ',';
}

/// Cuts a row into cells without the spaces around them; reuses `cells`.
void split_cells(std::string_view row, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const std::size_t end = row.find(separator);
    cells.push_back(reading::trimmed(row.substr(0, end)));
    if (end == std::string_view::npos) return;
    row.remove_prefix(end + 1);
  }
}

std::string column_name(std::string_view text) {
  if (text.size() > 1 && text.front() == '"' && text.back() == '"')
    text = text.substr(1, text.size() - 2);
  return reading::lower(text);
}

class PointReader {
 public:
  explicit PointReader(const fs::path& path)
      : is_stream_(is_standard_stream(path)), path_(is_stream_ ? "standard input" : path) {}

  PointTable read() {
    const std::string bytes =
        is_stream_ ? reading::read_standard_input() : reading::read_bytes(path_);
    reading::LineReader lines(bytes);
    while (lines.next()) {
      line_ = lines.line();
      if (table_.header.empty())
        first_row(lines.text());
      else
        row(lines.text());
    }
    if (table_.points.empty()) reading::fail(path_, 0, "the file has no points");
    return std::move(table_);
  }

 private:
  void first_row(std::string_view text) {
    table_.separator = separator_of(text);
    split_cells(text, table_.separator, cells_);
    count_ = cells_.size();
    const bool numbers = std::any_of(cells_.begin(), cells_.end(), [](std::string_view cell) {
      return reading::parse_double(cell).has_value();
    });
    if (!numbers) {
      find_columns();
      table_.header = text;
      return;
    }
    if (count_ != names.size())
      reading::fail(path_, line_,
                    fmt::format("a table without names needs six columns ({}), but this row has {}",
                                standard_header, count_));
    for (std::size_t k = 0; k < names.size(); ++k) columns_[k] = k;
    table_.header = standard_header;
    std::replace(table_.header.begin(), table_.header.end(), ',', table_.separator);
    row(text);
  }

  void find_columns() {
    for (std::size_t k = 0; k < names.size(); ++k) {
      std::size_t found = 0;
      for (std::size_t c = 0; c < cells_.size(); ++c)
        if (column_name(cells_[c]) == names[k]) {
          columns_[k] = c;
          ++found;
        }
      if (found != 1)
        reading::fail(
            path_, line_,
            fmt::format("the column '{}' is {}; needed are {}", names[k],
                        found == 0 ? "missing" : "there more than once", standard_header));
    }
  }

  void row(std::string_view text) {
    split_cells(text, table_.separator, cells_);
    if (cells_.size() != count_)
      reading::fail(path_, line_,
                    fmt::format("this row has {} column{}, but the first has {}", cells_.size(),
                                cells_.size() == 1 ? "" : "s", count_));
    std::array<double, 6> v{};
    for (std::size_t k = 0; k < names.size(); ++k)
      v[k] = reading::finite_number(cells_[columns_[k]], path_, line_);
    const Vec3 normal(v[3], v[4], v[5]);
    const double length = normal.stableNorm();
    if (!(length > 0))
      reading::fail(
          path_, line_,
          fmt::format("the normal of point {} has length zero", table_.points.size() + 1));
    // A normal of unit length stays as it is, to the last digit.
    const bool is_unit = std::abs(length - 1) < rounding;
    table_.points.push_back({{v[0], v[1], v[2]}, is_unit ? normal : normal.stableNormalized()});
    table_.rows.emplace_back(text);
  }

  bool is_stream_;
  fs::path path_;
  PointTable table_;
  Columns columns_{};
  std::size_t count_ = 0;  // of columns
  int line_ = 0;
  std::vector<std::string_view> cells_;
};

}  // namespace

PointTable read_points(const fs::path& path) { return PointReader(path).read(); }

PointTable point_table(std::vector<SurfacePoint> points) {
  PointTable table;
  table.header = standard_header;
  for (const SurfacePoint& p : points)
    table.rows.push_back(fmt::format("{},{},{},{},{},{}", p.position.x(), p.position.y(),
                                     p.position.z(), p.normal.x(), p.normal.y(), p.normal.z()));
  table.points = std::move(points);
  return table;
}

}  // namespace halfshade
