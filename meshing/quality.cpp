#include "meshing/quality.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {

double min_angle_degrees(const std::array<Vec3, 3>& triangle) {
  double least = 60;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 u = triangle[(k + 1) % 3] - triangle[k], v = triangle[(k + 2) % 3] - triangle[k];
    // Scaled, so that products of lengths neither overflow nor vanish.
    const double scale = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
    if (!(scale > 0)) return 0;
    const Vec3 p = u / scale, q = v / scale;
    least = std::min(least, std::atan2(p.cross(q).norm(), p.dot(q)) * 180 / std::numbers::pi);
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
    const double angle = angles[static_cast<std::size_t>(e)];
    summary.mean_angle += angle / static_cast<double>(angles.size());
    const auto bin = static_cast<std::size_t>(angle / 5);
    ++summary.histogram[std::min(bin, summary.histogram.size() - 1)];
    const auto triangle = elements.triangle(e);
    for (std::size_t k = 0; k < 3; ++k)
      summary.longest_edge =
          std::max(summary.longest_edge, (triangle[(k + 1) % 3] - triangle[k]).norm());
  }
  return summary;
}

}  // namespace halfshade
