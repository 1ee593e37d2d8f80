#include "solver/direct/emitter_parts.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/geometry/spread_pairs.h"
#include "solver/direct/ray_emitter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// Where light from the corners of an emitter, or its mean, is more than so many times the least, a
/// share of it by rays of weights that differ as much would be biased.
constexpr double uneven = 3;
constexpr std::size_t most_parts = 48;
/// Of a triangle in two: what is left is so small that its corners are as good as any point of it.
constexpr int most_halvings = 80;

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

double factor_of(const SurfacePoint& point, const std::array<Vec3, 3>& triangle,
                 std::vector<std::vector<Vec3>>& ring) {
  ring[0].assign(triangle.begin(), triangle.end());
  return unobstructed_factor(point.position, point.normal, ring);
}

/// Draws points of an emitter by the light that comes from its parts.
struct LightDraw {
  const SurfacePoint& point;
  const EmitterTarget& target;
  std::vector<LightPoint>& points;
  std::vector<std::vector<Vec3>> ring = std::vector<std::vector<Vec3>>(1);

  double factor(const std::array<Vec3, 3>& triangle) { return factor_of(point, triangle, ring); }

  /// In the part, or in halves of it.
  void draw(const EmitterPart& part, std::span<std::array<double, 2>> pairs, int halvings) {
    if (pairs.empty()) return;
    const double mean = std::numbers::pi * part.factor / area_of(part.triangle);
    const bool is_whole = halvings == 0 || is_even(point, target, part.triangle, mean, mean);
    const auto parts = halves(part.triangle);
    const double first = is_whole ? 0 : factor(parts[0]), second = is_whole ? 0 : factor(parts[1]);
    if (!(first + second > 0)) {
      for (const auto& [s, t] : pairs) {
        const Vec3 end = point_of(part.triangle, s, t);
        points.push_back({end, light_along(point, target, end - point.position) / mean});
      }
      return;
    }
    const std::size_t count = part_off(pairs, first / (first + second));
    draw({parts[0], first}, pairs.first(count), halvings - 1);
    draw({parts[1], second}, pairs.subspan(count), halvings - 1);
  }

  /// Those first whose s is below a share; s then runs from 0 to 1 again in each part.
  static std::size_t part_off(std::span<std::array<double, 2>> pairs, double share) {
    const auto end = std::stable_partition(pairs.begin(), pairs.end(), [&](const auto& pair) {
      return pair[0] < share || share >= 1;
    });
    for (auto pair = pairs.begin(); pair != end; ++pair) (*pair)[0] /= share;
    for (auto pair = end; pair != pairs.end(); ++pair)
      (*pair)[0] = std::clamp(((*pair)[0] - share) / (1 - share), 0., 1.);
    return static_cast<std::size_t>(end - pairs.begin());
  }
};

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
    const double factor = factor_of(point, triangle, ring);
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

void add_points_by_light(const SurfacePoint& point, const EmitterTarget& target,
                         std::span<const std::array<Vec3, 3>> triangles,
                         std::span<std::array<double, 2>> pairs, std::vector<LightPoint>& points) {
  LightDraw light{point, target, points};
  std::vector<double> factors;
  double left = 0;
  for (const std::array<Vec3, 3>& triangle : triangles)
    left += factors.emplace_back(light.factor(triangle));
  for (std::size_t k = 0; k < triangles.size() && !pairs.empty() && left > 0; ++k) {
    const std::size_t count = LightDraw::part_off(pairs, factors[k] / left);
    light.draw({triangles[k], factors[k]}, pairs.first(count), most_halvings);
    pairs = pairs.subspan(count);
    left -= factors[k];
  }
}

}  // namespace halfshade
