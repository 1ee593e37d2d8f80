#include "solver/elements/element_lookup.h"

#include "meshing/core/planar.h"
#include "meshing/core/plane_frame.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

constexpr double cells_per_element = 1;
/// Cells with more elements are quartered, down to sizes at which corners would be all that is
/// left. The smaller they are, the more they may have: few points lie there, and splinters side by
/// side would take thousands of cells each.
constexpr double most_in_cell = 4, more_in_quarter = 1.5;
constexpr int most_quarterings = 12;
/// So many may meet at a corner: where a quarter has no fewer of them, others would not either.
constexpr double most_at_corner = 8;
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

/// Whether a triangle reaches into a square, but for rounding: not if it lies beyond one of its
/// sides, or the square beyond one of the triangle's.
bool may_overlap(const std::array<Vec2, 3>& triangle, const Vec2& low, double size) {
  const auto& [a, b, c] = triangle;
  const Vec2 most = low + Vec2::Constant(size + cell_margin);
  if ((a.cwiseMax(b).cwiseMax(c) - low).minCoeff() < -cell_margin ||
      (most - a.cwiseMin(b).cwiseMin(c)).minCoeff() < 0)
    return false;
  const double turn = cross_2d(b - a, c - a) < 0 ? -1 : 1;
  const Vec2 middle = low + Vec2::Constant(size / 2);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 &p = triangle[k], along = triangle[(k + 1) % 3] - p;
    const double reach = (size / 2 + cell_margin) * (std::abs(along.x()) + std::abs(along.y()));
    if (turn * cross_2d(along, middle - p) < -reach) return false;
  }
  return true;
}

TrianglePlace clamped(const TrianglePlace& p) {
  const TrianglePlace q = p.cwiseMax(0.);
  return q.sum() > 1 ? TrianglePlace(q / q.sum()) : q;
}

}  // namespace

ElementLookup::PlaceMap ElementLookup::map_to_places(const std::array<Vec3, 3>& triangle,
                                                     const Vec3& normal) {
  const PlaneFrame frame = make_frame(triangle[0], normal);
  Eigen::Matrix2d edges;
  edges << frame.to_plane(triangle[1]), frame.to_plane(triangle[2]);
  Eigen::Matrix<double, 2, 3> to_plane;
  to_plane << frame.e1.transpose(), frame.e2.transpose();
  const Eigen::Matrix<double, 2, 3> slope = edges.inverse() * to_plane;
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  return {triangle[0], slope.allFinite() ? slope : slope.Constant(nowhere).eval()};
}

ElementLookup::ElementLookup(const ElementTable& elements) {
  for (int e = 0; e < elements.count(); ++e) {
    maps_.push_back(map_to_places(elements.triangle(e), elements.normal[at(e)]));
    const std::size_t surface = at(elements.surface[at(e)]);
    if (grids_.size() <= surface) grids_.resize(surface + 1);
    grids_[surface].elements.push_back(e);
  }
  for (Grid& grid : grids_)
    if (!grid.elements.empty()) fill(elements, grid);
  maps_.shrink_to_fit();
  cells_.shrink_to_fit();
  items_.shrink_to_fit();
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
  FlatTriangles triangles;
  std::vector<std::vector<int>> inside(at(grid.columns * grid.rows));  // of `triangles`
  for (const int e : grid.elements) {
    const auto corners = elements.triangle(e);
    auto& flat = triangles.emplace_back();
    Box2 box;
    for (std::size_t k = 0; k < 3; ++k)
      box.include(flat[k] = grid.to_cells * (corners[k] - grid.origin));
    for (int j = clamp_cell(box.low.y() - cell_margin, grid.rows);
         j <= clamp_cell(box.high.y() + cell_margin, grid.rows); ++j)
      for (int i = clamp_cell(box.low.x() - cell_margin, grid.columns);
           i <= clamp_cell(box.high.x() + cell_margin, grid.columns); ++i)
        inside[at(i + j * grid.columns)].push_back(static_cast<int>(triangles.size()) - 1);
  }
  grid.first_cell = static_cast<int>(cells_.size());
  cells_.resize(cells_.size() + inside.size());
  for (int c = 0; c < static_cast<int>(inside.size()); ++c) {
    const std::size_t first = items_.size();
    fill_cell(triangles, std::move(inside[at(c)]), grid.first_cell + c,
              {c % grid.columns, c / grid.columns}, 0, true);
    for (std::size_t i = first; i < items_.size(); ++i) items_[i] = grid.elements[at(items_[i])];
  }
}

void ElementLookup::fill_cell(const FlatTriangles& triangles, std::vector<int> inside, int cell,
                              const Vec2& low, int quarterings, bool is_fewer) {
  const double share = static_cast<double>(inside.size()) / std::pow(more_in_quarter, quarterings);
  if (share <= most_in_cell || quarterings == most_quarterings ||
      (share <= most_at_corner && !is_fewer)) {
    cells_[at(cell)].first = static_cast<int>(items_.size());
    items_.insert(items_.end(), inside.begin(), inside.end());
    cells_[at(cell)].end = static_cast<int>(items_.size());
    return;
  }
  const int first = static_cast<int>(cells_.size());
  cells_[at(cell)] = {first, -1};
  cells_.resize(cells_.size() + 4);
  const double size = std::ldexp(1, -quarterings - 1);
  for (int k = 0; k < 4; ++k) {
    const Vec2 corner = low + size * Vec2(k % 2, k / 2);
    std::vector<int> here;
    for (const int t : inside)
      if (may_overlap(triangles[at(t)], corner, size)) here.push_back(t);
    const bool fewer = here.size() < inside.size();
    fill_cell(triangles, std::move(here), first + k, corner, quarterings + 1, fewer);
  }
}

const ElementLookup::Cell& ElementLookup::cell_at(const Grid& grid, Vec2 q) const {
  const int i = clamp_cell(q.x(), grid.columns), j = clamp_cell(q.y(), grid.rows);
  q -= Vec2(i, j);
  int cell = grid.first_cell + i + j * grid.columns;
  while (cells_[at(cell)].end < 0) {
    q *= 2;
    const bool right = q.x() >= 1, up = q.y() >= 1;
    q -= Vec2(right, up);
    cell = cells_[at(cell)].first + (right ? 1 : 0) + (up ? 2 : 0);
  }
  return cells_[at(cell)];
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
    if (!(least > most)) return;
    most = least;
    best = {e, place};
  };
  const Cell& cell = cell_at(grid, grid.to_cells * (position - grid.origin));
  for (int i = cell.first; i < cell.end && most < -edge_margin; ++i) look_at(items_[at(i)]);
  if (best.triangle < 0)
    for (const int e : grid.elements) look_at(e);
  if (best.triangle < 0) return {};  // the point is not finite
  best.place = clamped(best.place);
  return best;
}

}  // namespace halfshade
