#include "io/read/lamp_error.h"

#include "meshing/core/plane_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace halfshade::reading {
namespace {

constexpr std::size_t most_places = 128;
/// What a piece shows where a border cuts it anywhere, squared, of what the best cut takes away of
/// its squared deviation: exitance that rises evenly across it shows (√12/2)²/30 of all on the
/// average, and a cut in the middle takes away 3/4.
constexpr double best_cut = 0.75, shown_if_cut = 0.1 / best_cut;
/// Borders of shadows, or so, that cross a lamp as a point sees it.
constexpr double borders = 1;

}  // namespace

LampError::LampError(const PictureGrid& grid, const Paint& paint, std::span<const Vec3> polygon,
                     bool two_sided, const LightReceivers& receivers)
    : grid_(grid) {
  look_into_cells();
  const PlaneFrame frame = fit_plane(polygon);
  const double lamp_area = area_vector(polygon).norm();
  // Form factors to the lamp as if it were a disc, to choose by.
  std::vector<std::pair<double, Place>> found;
  double all = 0;
  for (const LightReceiver& receiver : receivers.points) {
    Place place{receiver,
                frame.to_plane(receiver.position),
                frame.height(receiver.position),
                receiver.normal.dot(frame.e1),
                receiver.normal.dot(frame.e2),
                receiver.normal.dot(frame.normal)};
    if (two_sided && place.height < 0) {
      place.height = -place.height;
      place.along = -place.along;
    }
    const bool is_above = std::any_of(polygon.begin(), polygon.end(), [&](const Vec3& p) {
      return receiver.normal.dot(p - receiver.position) > 0;
    });
    if (!(place.height > 0) || !is_above) continue;
    const double squared = place.foot.squaredNorm() + place.height * place.height;
    const double factor = lamp_area / (std::numbers::pi * squared + lamp_area);
    found.emplace_back(receiver.area * factor * factor, place);
    all += found.back().first;
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (found.size() > most_places) found.resize(most_places);
  double kept = 0;
  for (const auto& [weight, place] : found) {
    kept += weight;
    places_.push_back(place);
  }
  if (kept > 0) missed_ = all / kept;

  Eigen::Matrix2d map;
  map.col(0) = paint.along * frame.e1;
  map.col(1) = paint.along * frame.e2;
  constexpr double flat = 1e-9;
  if (!(std::abs(map.determinant()) > flat * map.squaredNorm())) return;
  const Eigen::Matrix2d back = map.inverse();
  const Vec2 origin = paint.place(frame.origin);
  for (int row = 0; row < grid.lines[1].cells; ++row)
    for (int column = 0; column < grid.lines[0].cells; ++column)
      middle_.emplace_back(back * (Vec2(grid.lines[0].line(column) + grid.lines[0].line(column + 1),
                                        grid.lines[1].line(row) + grid.lines[1].line(row + 1)) /
                                       2 -
                                   origin));
}

/// Exitance that rises across a cell sends what even exitance does, and a dipole's light, which is
/// that of its two neighbours with more and with less.
void LampError::look_into_cells() {
  value_ = grid_.value;
  rising_.assign(value_.size(), 0);
  const std::array<int, 2> cells = {grid_.lines[0].cells, grid_.lines[1].cells};
  for (int row = 0; row < cells[1]; ++row)
    for (int column = 0; column < cells[0]; ++column)
      for (const int axis : {0, 1}) {
        const int here = axis == 0 ? column : row;
        const int low = std::max(here - 1, 0), high = std::min(here + 1, cells[at(axis)] - 1);
        const auto along = [&](int k) {
          return axis == 0 ? grid_.cell(k, row) : grid_.cell(column, k);
        };
        const std::size_t a = along(low), b = along(high), cell = along(here);
        if (low == high || !(grid_.area[cell] > 0 && grid_.area[a] > 0 && grid_.area[b] > 0))
          continue;
        const Rgb rise = (grid_.value[b] - grid_.value[a]) / (high - low);
        rising_[cell] += rise.square().sum() / 12;
        const Rgb dipole = grid_.area[cell] * rise / (12 * (high - low));
        value_[b] += dipole / grid_.area[b];
        value_[a] -= dipole / grid_.area[a];
      }
}

double LampError::squared(const std::vector<PicturePiece>& pieces) const {
  struct CellLight {
    double x, y, area;
    Rgb more;
  };
  struct PieceLight {
    std::vector<CellLight> cells;
    double gain;  ///< of the best cut, mean square
  };
  std::vector<PieceLight> lights;
  double area = 0, deviation = 0;
  for (const PicturePiece& piece : pieces) {
    area += piece.sum.area;
    deviation += piece.sum.deviation();
    if (middle_.empty() || !(piece.sum.area > 0)) continue;
    PieceLight& light = lights.emplace_back();
    light.gain = piece.gain / piece.sum.area;
    const Rgb mean = piece.sum.mean();
    for (int row = piece.block.low[1]; row < piece.block.end[1]; ++row)
      for (int column = piece.block.low[0]; column < piece.block.end[0]; ++column) {
        const std::size_t cell = grid_.cell(column, row);
        if (grid_.area[cell] > 0)
          light.cells.push_back(
              {middle_[cell].x(), middle_[cell].y(), grid_.area[cell], Rgb(value_[cell] - mean)});
        light.gain += best_cut * rising_[cell] * grid_.area[cell] / piece.sum.area;
      }
  }
  const double crossed =
      shown_if_cut * borders / std::sqrt(std::max(1., static_cast<double>(lights.size())));
  double sum = 0;
  for (const Place& place : places_) {
    Rgb off = Rgb::Zero();
    double at_borders = 0;
    const double squared_height = place.height * place.height;
    for (const PieceLight& light : lights) {
      double factor = 0;
      for (const CellLight& cell : light.cells) {
        const double x = cell.x - place.foot.x(), y = cell.y - place.foot.y();
        // Of the way up to the cell.
        const double here = x * place.across_e1 + y * place.across_e2 - place.height * place.along;
        if (!(here > 0)) continue;
        const double squared = x * x + y * y + squared_height;
        const double share =
            here * place.height * cell.area / (squared * (std::numbers::pi * squared + cell.area));
        factor += share;
        off += share * cell.more;
      }
      at_borders += light.gain * factor * factor;
    }
    if (middle_.empty()) {  // at most
      const double factor =
          area / (std::numbers::pi * (squared_height + place.foot.squaredNorm()) + area);
      at_borders = factor * factor * deviation / area / crossed;
    }
    sum += place.receiver.area * (off.square().sum() + crossed * at_borders);
  }
  return missed_ * sum;
}

}  // namespace halfshade::reading
