#include "solver/elements/element_lookup.h"

#include "meshing/core/plane_frame.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

constexpr double cells_per_element = 2;
/// Points that rounding puts beside their element are looked for in its cells, too.
constexpr double cell_margin = 1e-6;
/// Points this close to an edge lie in the first of the elements at it: symmetric places lie there
/// exactly, and their rounding, which changes with the unit of length, is not to choose.
constexpr double edge_margin = 1e-10;

int clamp_cell(double x, int count) {
  return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1);
}

struct Box2 {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;

  void include(const Vec2& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

TrianglePlace clamped(const TrianglePlace& p) {
  const TrianglePlace q = p.cwiseMax(0.);
  return q.sum() > 1 ? TrianglePlace(q / q.sum()) : q;
}

}  // namespace

ElementLookup::ElementLookup(const ElementTable& elements) : starts_{0} {
  for (int e = 0; e < elements.count(); ++e) {
    const auto corner = elements.triangle(e);
    Eigen::Matrix<double, 3, 2> edges;
    edges << corner[1] - corner[0], corner[2] - corner[0];
    maps_.push_back({corner[0], edges.colPivHouseholderQr().solve(Eigen::Matrix3d::Identity())});
    const std::size_t surface = at(elements.surface[at(e)]);
    if (grids_.size() <= surface) grids_.resize(surface + 1);
    grids_[surface].elements.push_back(e);
  }
  for (Grid& grid : grids_)
    if (!grid.elements.empty()) fill(elements, grid);
}

void ElementLookup::fill(const ElementTable& elements, Grid& grid) {
  const int first = grid.elements.front();
  const PlaneFrame frame = make_frame(elements.triangle(first)[0], elements.normal[at(first)]);
  Box2 all;
  for (const int e : grid.elements)
    for (const Vec3& p : elements.triangle(e)) all.include(frame.to_plane(p));
  const Vec2 size = all.high - all.low;
  const double wanted = cells_per_element * static_cast<double>(grid.elements.size());
  const double aspect = std::clamp(size.x() / size.y(), 1 / wanted, wanted);
  grid.columns = std::max(1, static_cast<int>(std::sqrt(wanted * aspect)));
  grid.rows = std::max(1, static_cast<int>(std::sqrt(wanted / aspect)));
  grid.origin = frame.to_space(all.low);
  grid.to_cells.row(0) = grid.columns / size.x() * frame.e1.transpose();
  grid.to_cells.row(1) = grid.rows / size.y() * frame.e2.transpose();
  std::vector<std::vector<int>> cells(at(grid.columns * grid.rows));
  for (const int e : grid.elements) {
    Box2 box;
    for (const Vec3& p : elements.triangle(e)) box.include(grid.to_cells * (p - grid.origin));
    for (int j = clamp_cell(box.low.y() - cell_margin, grid.rows);
         j <= clamp_cell(box.high.y() + cell_margin, grid.rows); ++j)
      for (int i = clamp_cell(box.low.x() - cell_margin, grid.columns);
           i <= clamp_cell(box.high.x() + cell_margin, grid.columns); ++i)
        cells[at(i + j * grid.columns)].push_back(e);
  }
  grid.first_cell = static_cast<int>(starts_.size()) - 1;
  for (const std::vector<int>& cell : cells) {
    items_.insert(items_.end(), cell.begin(), cell.end());
    starts_.push_back(static_cast<int>(items_.size()));
  }
}

int ElementLookup::cell_of(const Grid& grid, const Vec2& q) const {
  return grid.first_cell + clamp_cell(q.x(), grid.columns) +
         clamp_cell(q.y(), grid.rows) * grid.columns;
}

ForestPlace ElementLookup::find(int surface, const Vec3& position) const {
  if (surface < 0 || at(surface) >= grids_.size() || grids_[at(surface)].elements.empty())
    return {};
  const Grid& grid = grids_[at(surface)];
  ForestPlace best;
  double most = -std::numeric_limits<double>::infinity();
  const auto look_at = [&](int e) {
    const PlaceMap& map = maps_[at(e)];
    const TrianglePlace place = map.slope * (position - map.origin);
    const double least = std::min({place.x(), place.y(), 1 - place.x() - place.y()});
    if (least <= most) return;
    most = least;
    best = {e, place};
  };
  const int cell = cell_of(grid, grid.to_cells * (position - grid.origin));
  for (int i = starts_[at(cell)]; i < starts_[at(cell) + 1] && most < -edge_margin; ++i)
    look_at(items_[at(i)]);
  if (best.triangle < 0)
    for (const int e : grid.elements) look_at(e);
  if (best.triangle < 0) return {};  // the point is not finite
  best.place = clamped(best.place);
  return best;
}

}  // namespace halfshade
