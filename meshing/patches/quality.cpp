#include "meshing/patches/quality.h"

#include "meshing/geometry/corner_fans.h"
#include "meshing/patches/margins.h"
#include "meshing/triangulation/planar_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

constexpr double bin_width = 5;
constexpr double degrees = 180 / std::numbers::pi;

std::size_t bin_of(double angle, std::size_t bins) {
  return std::min(static_cast<std::size_t>(angle / bin_width), bins - 1);
}

double corner_angle(const std::array<Vec3, 3>& triangle, std::size_t k) {
  const Vec3 u = triangle[(k + 1) % 3] - triangle[k], v = triangle[(k + 2) % 3] - triangle[k];
  return std::atan2(u.cross(v).norm(), u.dot(v)) * degrees;
}

}  // namespace

double min_angle_degrees(const std::array<Vec3, 3>& triangle) {
  double least = 60;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 u = triangle[(k + 1) % 3] - triangle[k], v = triangle[(k + 2) % 3] - triangle[k];
    // Scaled, so that products of lengths neither overflow nor vanish.
    const double scale = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
    if (!(scale > 0)) return 0;
    const Vec3 p = u / scale, q = v / scale;
    least = std::min(least, std::atan2(p.cross(q).norm(), p.dot(q)) * degrees);
  }
  return least;
}

std::vector<double> min_angles(const ElementTable& elements) {
  std::vector<double> angles;
  angles.reserve(elements.corners.size());
  for (int e = 0; e < elements.count(); ++e)
    angles.push_back(min_angle_degrees(elements.triangle(e)));
  return angles;
}

QualitySummary summarize_quality(const ElementTable& elements) {
  QualitySummary summary;
  const std::vector<double> angles = min_angles(elements);
  if (angles.empty()) return summary;
  const auto worst = std::min_element(angles.begin(), angles.end());
  summary.worst_element = static_cast<int>(worst - angles.begin());
  summary.min_angle = *worst;
  for (int e = 0; e < elements.count(); ++e) {
    const double angle = angles[at(e)];
    summary.mean_angle += angle / static_cast<double>(angles.size());
    ++summary.histogram[bin_of(angle, summary.histogram.size())];
    const auto triangle = elements.triangle(e);
    for (std::size_t k = 0; k < 3; ++k)
      summary.longest_edge =
          std::max(summary.longest_edge, (triangle[(k + 1) % 3] - triangle[k]).norm());
  }
  return summary;
}

// Corners that follow each other around a point without a constrained edge between them make up a
// sector.
std::vector<bool> at_input_angles(const ElementTable& elements) {
  std::vector<std::array<int, 3>> joined = elements.neighbours;
  for (std::size_t e = 0; e < joined.size(); ++e)
    for (std::size_t k = 0; k < 3; ++k)
      if (elements.edge_order[e][k] >= 0) joined[e][k] = -1;
  const CornerFans sectors = corner_fans(elements.corners, joined);
  std::vector<double> angle(at(sectors.count), 0);
  std::vector<bool> bounded(at(sectors.count), false);
  for (int e = 0; e < elements.count(); ++e)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto sector = at(sectors.of_corner[at(e)][k]);
      angle[sector] += corner_angle(elements.triangle(e), k);
      if (joined[at(e)][k] < 0) bounded[sector] = true;
    }
  std::vector<bool> narrow(elements.points.size(), false);
  for (std::size_t e = 0; e < joined.size(); ++e)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto sector = at(sectors.of_corner[e][k]);
      if (bounded[sector] && angle[sector] < margins::narrow_angle)
        narrow[at(elements.corners[e][k])] = true;
    }
  std::vector<bool> result;
  for (const auto& corners : elements.corners)
    result.push_back(
        std::any_of(corners.begin(), corners.end(), [&](int p) { return narrow[at(p)]; }));
  return result;
}

AreaQuality summarize_area_quality(const ElementTable& elements) {
  AreaQuality summary;
  const std::vector<double> angles = min_angles(elements);
  const std::vector<bool> exempt = at_input_angles(elements);
  double total = 0, rest = 0, good = 0, tolerable = 0;
  for (const double area : elements.area) total += area;
  for (std::size_t e = 0; e < angles.size(); ++e) {
    const double area = elements.area[e];
    summary.histogram[bin_of(angles[e], summary.histogram.size())] += area / total;
    if (exempt[e]) {
      summary.near_input_angles += area / total;
      continue;
    }
    rest += area;
    if (angles[e] >= delaunay_angle) good += area;
    if (angles[e] >= margins::tolerable_angle) tolerable += area;
    summary.min_angle = std::min(summary.min_angle, angles[e]);
  }
  if (rest > 0) {
    summary.good = good / rest;
    summary.tolerable = tolerable / rest;
  }
  return summary;
}

}  // namespace halfshade
