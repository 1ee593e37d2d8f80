#include "solver/factors/points_across.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace halfshade {
namespace {

/// Of a lattice, under what lies close above the surface.
constexpr double points_under_it = 4;

}  // namespace

/// `measure` tells sides in units of what they are covered with.
template <class Measure>
double PointsAcross::most_of_quads(Measure measure) const {
  double most = 0;
  for (const Quad& quad : quads_) {
    std::array<Vec3, 4> sides;
    for (std::size_t k = 0; k < 4; ++k) {
      sides[k] = measure(Vec3(quad[(k + 1) % 4] - quad[k]));
      most = std::max(most, sides[k].norm());
    }
    for (std::size_t k = 0; k < 4; ++k)
      most = std::max(most, sides[k].cross(sides[(k + 1) % 4]).norm());
  }
  return most;
}

PointsAcross::PointsAcross(const PlaneFrame& surface, std::span<const Quad> quads,
                           const Ball& target)
    : surface_(surface), quads_(quads) {
  points_ = most_of_quads([&](const Vec3& side) -> Vec3 { return side / target.radius; });
}

double PointsAcross::points_under(std::span<const Vec3> corners, double width) const {
  const bool is_near = std::all_of(corners.begin(), corners.end(), [&](const Vec3& p) {
    return std::abs(surface_.height(p)) < width;
  });
  return is_near ? points_under_it : 1;
}

void PointsAcross::add(const ConvexBody& body) {
  const double points = most_of_quads([&](const Vec3& side) -> Vec3 { return side / body.width; });
  points_ = std::max(points_, points_under(body.vertices, body.width) * points);
}

void PointsAcross::add(const Blocker& polygon) {
  const double points = most_of_quads([&](const Vec3& side) -> Vec3 {
    const Vec3 along = side.dot(polygon.along) * polygon.along;
    return (side - along) / polygon.width + along / polygon.length;
  });
  points_ = std::max(points_, points_under(polygon.corners, polygon.width) * points);
}

}  // namespace halfshade
