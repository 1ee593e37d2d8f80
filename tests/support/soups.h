#pragma once

#include "meshing/rays/visibility.h"
#include "tests/support/random.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

/// Triangle soups and random segments for the tests of visibility.
namespace halfshade::test {

inline void add_triangle(TriangleSoup& soup, const Vec3& a, const Vec3& b, const Vec3& c,
                         int owner = -1, int plane = -1) {
  const int first = static_cast<int>(soup.points.size());
  soup.points.insert(soup.points.end(), {a, b, c});
  soup.triangles.push_back({first, first + 1, first + 2});
  soup.owner.push_back(owner < 0 ? static_cast<int>(soup.owner.size()) : owner);
  soup.plane.push_back(plane);
}

/// Triangles of about the given size with corners strewn over [0, 1]³; each owns itself.
inline TriangleSoup random_soup(int count, double size, Random& random) {
  TriangleSoup soup;
  for (int t = 0; t < count; ++t) {
    const Vec3 p = random.point(0, 1);
    const Vec3 q = p + random.point(-size, size), r = p + random.point(-size, size);
    add_triangle(soup, p, q, r);
  }
  return soup;
}

/// A closed sphere of radius 1 about the origin, outward, with shared corners.
inline TriangleSoup sphere(int rings, int sectors) {
  TriangleSoup soup;
  constexpr double pi = 3.14159265358979323846;
  soup.points.emplace_back(0, 0, 1);
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < sectors; ++s) {
      const double theta = pi * r / rings, phi = 2 * pi * s / sectors;
      soup.points.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                               std::cos(theta));
    }
  soup.points.emplace_back(0, 0, -1);
  const int south = static_cast<int>(soup.points.size()) - 1;
  const auto at = [&](int r, int s) { return 1 + (r - 1) * sectors + s % sectors; };
  for (int s = 0; s < sectors; ++s) {
    soup.triangles.push_back({0, at(1, s), at(1, s + 1)});
    soup.triangles.push_back({south, at(rings - 1, s + 1), at(rings - 1, s)});
    for (int r = 1; r + 1 < rings; ++r) {
      soup.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      soup.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
  }
  soup.owner.assign(soup.triangles.size(), 0);
  soup.plane.assign(soup.triangles.size(), -1);
  return soup;
}

inline std::array<Vec3, 3> corners(const TriangleSoup& soup, std::size_t triangle) {
  std::array<Vec3, 3> out;
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = soup.points[static_cast<std::size_t>(soup.triangles[triangle][k])];
  return out;
}

/// Where a segment crosses a triangle: positive inside, and how clearly so (the least of the
/// barycentric coordinates and of the distances from the segment's ends in parts of its length),
/// in extended precision (Möller and Trumbore 1997).
inline double clearance(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const Long a = triangle[0].cast<long double>(), o = from.cast<long double>();
  const Long u = triangle[1].cast<long double>() - a, v = triangle[2].cast<long double>() - a;
  const Long d = to.cast<long double>() - o, p = d.cross(v), s = o - a, q = s.cross(u);
  const long double det = u.dot(p);
  if (det == 0) return -1;
  const long double b1 = s.dot(p) / det, b2 = d.dot(q) / det, t = v.dot(q) / det;
  return static_cast<double>(std::min({b1, b2, 1 - b1 - b2, t, 1 - t}));
}

/// The clearest crossing of a segment with any triangle of a soup.
inline double clearance(const Vec3& from, const Vec3& to, const TriangleSoup& soup) {
  double best = -1;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    best = std::max(best, clearance(from, to, corners(soup, t)));
  return best;
}

}  // namespace halfshade::test
