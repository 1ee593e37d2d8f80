#include "solver/elements/vertex_interpolation.h"

#include "solver/elements/vertex_values.h"

#include <Eigen/QR>

#include <algorithm>
#include <utility>

namespace halfshade {
namespace {

/// So far from a border point elements are looked at: in a corner there are few.
constexpr int most_rings = 3;

/// The elements at each point.
std::vector<std::vector<int>> elements_at_points(const ElementTable& elements) {
  std::vector<std::vector<int>> around(elements.points.size());
  for (int e = 0; e < elements.count(); ++e)
    for (const int p : elements.corners[at(e)]) around[at(p)].push_back(e);
  return around;
}

std::vector<bool> border_points(const ElementTable& elements) {
  std::vector<bool> is_border(elements.points.size());
  for (int e = 0; e < elements.count(); ++e)
    for (std::size_t k = 0; k < 3; ++k)
      if (elements.neighbours[at(e)][k] < 0)
        is_border[at(elements.corners[at(e)][k])] =
            is_border[at(elements.corners[at(e)][(k + 1) % 3])] = true;
  return is_border;
}

/// Elements and their neighbours, each once.
std::vector<int> with_neighbours(const ElementTable& elements, std::vector<int> some) {
  const std::size_t own = some.size();
  for (std::size_t k = 0; k < own; ++k)
    for (const int n : elements.neighbours[at(some[k])])
      if (n >= 0) some.push_back(n);
  std::sort(some.begin(), some.end());
  some.erase(std::unique(some.begin(), some.end()), some.end());
  return some;
}

/// The plane a + b u + c v nearest to the elements' values, at a point; false, and `value` as it
/// was, where the elements lie in a line.
bool extrapolate(const ElementTable& elements, const ChannelArray& values,
                 const std::vector<int>& nearby, const Vec3& point,
                 Eigen::Ref<Eigen::RowVector3d> value) {
  const int first = nearby.front();
  const auto corners = elements.triangle(first);
  const Vec3 u = (corners[1] - corners[0]).normalized(), v = elements.normal[at(first)].cross(u);
  const double size = (corners[1] - corners[0]).norm();
  const auto count = static_cast<Eigen::Index>(nearby.size());
  Eigen::MatrixX3d planes(count, 3), wanted(count, 3);
  for (Eigen::Index k = 0; k < count; ++k) {
    const int e = nearby[static_cast<std::size_t>(k)];
    const auto t = elements.triangle(e);
    const Vec3 off = ((t[0] + t[1] + t[2]) / 3 - point) / size;
    planes.row(k) << 1, off.dot(u), off.dot(v);
    wanted.row(k) = values.row(e).matrix();
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> fit(planes);
  if (fit.rank() < 3) return false;
  const Eigen::RowVector3d found = fit.solve(wanted).row(0);
  const Eigen::RowVector3d least = wanted.colwise().minCoeff().cwiseMin(0.);
  value = found.cwiseMax(least);
  return true;
}

}  // namespace

ChannelArray interpolated_at_points(const ElementTable& elements,
                                    const ChannelArray& element_values) {
  ChannelArray at_points = values_at_points(elements, element_values);
  const auto around = elements_at_points(elements);
  const std::vector<bool> is_border = border_points(elements);
  for (std::size_t p = 0; p < around.size(); ++p) {
    if (!is_border[p] || around[p].empty()) continue;
    const auto row = static_cast<Eigen::Index>(p);
    Eigen::RowVector3d value = at_points.row(row).matrix();
    std::vector<int> nearby = around[p];
    for (int ring = 0; ring < most_rings; ++ring) {
      nearby = with_neighbours(elements, std::move(nearby));
      if (extrapolate(elements, element_values, nearby, elements.points[p], value)) break;
    }
    at_points.row(row) = value.array();
  }
  return at_points;
}

ElementField interpolated_field(const ElementTable& elements, const ChannelArray& element_values) {
  const ChannelArray at_points = interpolated_at_points(elements, element_values);
  const Eigen::Matrix3d from_corners = element_node_basis(1).inverse();
  ElementField field = zero_field(std::vector<int>(elements.corners.size(), 1));
  for (int e = 0; e < elements.count(); ++e) {
    Eigen::Matrix3d corners;
    for (Eigen::Index k = 0; k < 3; ++k)
      corners.row(k) = at_points.row(elements.corners[at(e)][static_cast<std::size_t>(k)]).matrix();
    field.of(e) = (from_corners * corners).array();
  }
  return field;
}

}  // namespace halfshade
