#pragma once

#include "meshing/rays/occluders.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace halfshade {

/// A triangle of a soup with its plane.
struct SoupTriangle {
  std::array<Vec3, 3> corner;
  Vec3 normal;       // unit length; zero for a triangle without area
  double size;       // its longest extent along an axis
  double magnitude;  // the largest coordinate
  int index;         // in the soup
  int plane;

  SoupTriangle(const TriangleSoup& soup, int triangle)
      : index(triangle), plane(soup.plane[at(triangle)]) {
    for (std::size_t k = 0; k < 3; ++k)
      corner[k] = soup.points[at(soup.triangles[at(triangle)][k])];
    normal = edge(0).cross(edge(1));
    const double twice_area = normal.norm();
    if (twice_area > 0) normal /= twice_area;
    const Vec3 low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]);
    const Vec3 high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
    size = (high - low).maxCoeff();
    magnitude = std::max(-low.minCoeff(), high.maxCoeff());
  }
  Vec3 edge(std::size_t k) const { return corner[(k + 1) % 3] - corner[k]; }
  double height(const Vec3& p) const { return normal.dot(p - corner[0]); }
  /// Twice the signed area that point p of the plane spans with edge k.
  double area(std::size_t k, const Vec3& p) const {
    return normal.dot(edge(k).cross(p - corner[k]));
  }
  /// How far off the plane, or outside the border, rounding may put a point: a share of the
  /// triangle's size, and roundings of coordinates far from the origin.
  double margin(const Vec3& p, double share) const {
    constexpr double roundings = 16 * std::numeric_limits<double>::epsilon();
    return share * size + roundings * std::max(magnitude, p.lpNorm<Eigen::Infinity>());
  }
  /// +1 or −1 for points clearly on one side of the plane, else 0.
  int side(const Vec3& p) const {
    const double h = height(p), in_plane = margin(p, 1e-10);
    return h > in_plane ? 1 : h < -in_plane ? -1 : 0;
  }
  /// Whether a point of the plane lies in the triangle or as good as on an edge's line.
  bool contains(const Vec3& p) const {
    const double tolerance = margin(p, 1e-12);
    for (std::size_t k = 0; k < 3; ++k)
      if (const double a = area(k, p);
          a < 0 && a * a > tolerance * tolerance * edge(k).squaredNorm())
        return false;
    return true;
  }
  /// Barycentric coordinates, none negative, their sum 1.
  std::array<double, 3> weights(const Vec3& p) const {
    std::array<double, 3> w{};
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += w[(k + 2) % 3] = std::max(area(k, p), 0.0);
    for (double& x : w) x = sum > 0 ? x / sum : 1.0 / 3;
    return w;
  }
};

/// The triangle with its edges moved outwards; corners move by at most `miter` times as much.
inline std::array<Vec3, 3> enlarged(const SoupTriangle& triangle, double distance, double miter) {
  std::array<Vec3, 3> out = triangle.corner;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 in = triangle.edge((k + 2) % 3).stableNormalized();
    const Vec3 away = triangle.edge(k).stableNormalized();
    const double sine = triangle.normal.dot(in.cross(away));  // of the angle at the corner
    if (sine > 0) out[k] += distance * std::min(1 / sine, miter / 2) * (in - away);
  }
  return out;
}

}  // namespace halfshade
