#include "solver/direct/emitter_parts.h"

#include "meshing/backprojection/edge_sum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// Where light from the corners of an emitter, or its mean, is more than so many times the least, a
/// share of it by rays of weights that differ as much would be biased.
constexpr double uneven = 3;
constexpr std::size_t most_parts = 48;

bool is_even(const SurfacePoint& point, const EmitterTarget& target, std::span<const Vec3> corners,
             double least, double most) {
  for (const Vec3& corner : corners) {
    const double light = light_along(point, target, corner - point.position);
    least = std::min(least, light);
    most = std::max(most, light);
  }
  return most <= uneven * least;
}

double area_of(const std::array<Vec3, 3>& t) {
  return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
}

/// Across the longest edge.
std::array<std::array<Vec3, 3>, 2> halves(const std::array<Vec3, 3>& t) {
  std::size_t longest = 0;
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double of_edge = (t[(k + 1) % 3] - t[k]).squaredNorm();
    if (of_edge > square) square = of_edge, longest = k;
  }
  const Vec3 &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3];
  const Vec3 middle = 0.5 * (a + b);
  return {{{a, middle, c}, {middle, b, c}}};
}

}  // namespace

double light_along(const SurfacePoint& point, const EmitterTarget& target, const Vec3& way) {
  const double square = way.squaredNorm();
  return std::max(point.normal.dot(way), 0.) * std::max(-target.normal.dot(way), 0.) /
         (square * square);
}

bool is_even(const SurfacePoint& point, const EmitterTarget& target, double area, double factor) {
  const double mean = std::numbers::pi * factor / area;
  return std::all_of(target.rings.begin(), target.rings.end(), [&](const std::vector<Vec3>& ring) {
    return is_even(point, target, ring, mean, mean);
  });
}

bool cut_evenly(const SurfacePoint& point, const EmitterTarget& target,
                std::span<const std::array<Vec3, 3>> triangles, double negligible,
                std::vector<EmitterPart>& parts) {
  const std::size_t begin = parts.size();
  std::vector<std::vector<Vec3>> ring(1);
  const auto append = [&](const std::array<Vec3, 3>& triangle) {
    ring[0].assign(triangle.begin(), triangle.end());
    const double factor = unobstructed_factor(point.position, point.normal, ring);
    if (factor > 0) parts.push_back({triangle, factor});
  };
  for (const std::array<Vec3, 3>& triangle : triangles) append(triangle);
  for (std::size_t k = begin; k < parts.size();) {
    const EmitterPart part = parts[k];
    const double mean = std::numbers::pi * part.factor / area_of(part.triangle);
    if (part.factor < negligible || is_even(point, target, part.triangle, mean, mean)) {
      ++k;
      continue;
    }
    if (parts.size() - begin >= most_parts) {
      parts.resize(begin);
      return false;
    }
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(k));
    for (const std::array<Vec3, 3>& half : halves(part.triangle)) append(half);
  }
  return true;
}

}  // namespace halfshade
