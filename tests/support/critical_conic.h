#pragma once

#include "meshing/core/plane_frame.h"
#include "meshing/geometry/line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

/// Where three lines line up, derived without line families: an independent check of them.
namespace halfshade::test {

namespace detail {

/// det[a, b, c].
inline double det(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)); }

/// A sum of three determinants of rounded differences, or 0 if it is rounding of terms of this
/// size.
inline double unless_rounding(double sum, double size) {
  constexpr double determinant_error = 32 * std::numeric_limits<double>::epsilon();
  return std::abs(sum) > determinant_error * size ? sum : 0;
}

}  // namespace detail

/// constant + u u + v v + uu u² + uv u v + vv v² = 0 in the coordinates (u, v) of a plane.
struct Conic {
  double constant = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

inline double value(const Conic& conic, const Vec2& p) {
  const double u = p.x(), v = p.y();
  return conic.constant + u * (conic.u + conic.uu * u + conic.uv * v) +
         v * (conic.v + conic.vv * v);
}

inline Vec2 gradient(const Conic& conic, const Vec2& p) {
  const double u = p.x(), v = p.y();
  return {conic.u + 2 * conic.uu * u + conic.uv * v, conic.v + conic.uv * u + 2 * conic.vv * v};
}

/// Where three lines line up, seen from the points of a plane: their common transversals sweep a
/// quadric det[n₁, n₂, n₃](x) = 0 with nᵢ = (aᵢ − x) × dᵢ (its cubic terms cancel), cut with the
/// plane. The largest coefficient is ±1, those within their rounding error are 0; all are if the
/// lines line up from every point. If two of the lines meet it is a pair of straight lines.
///
/// On the plane x = o + u e1 + v e2 the normals are nᵢ = αᵢ + u βᵢ + v γᵢ with αᵢ = (aᵢ − o) × dᵢ,
/// βᵢ = dᵢ × e1 and γᵢ = dᵢ × e2, and the determinant is expanded by columns.
inline Conic critical_conic(const std::array<Line3, 3>& lines, const PlaneFrame& receiver) {
  std::array<Vec3, 3> a, b, c;
  Vec3 far;  // bounds for the lengths of the αᵢ; those of βᵢ and γᵢ are at most 1
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 d = lines[i].direction.stableNormalized();
    const Vec3 offset = lines[i].point - receiver.origin;
    a[i] = offset.cross(d);
    b[i] = d.cross(receiver.e1);
    c[i] = d.cross(receiver.e2);
    far[static_cast<int>(i)] = offset.norm();
  }
  const double far2 = far[0] * far[1] + far[1] * far[2] + far[2] * far[0];
  const auto one_of = [&](const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q, double size) {
    return detail::unless_rounding(detail::det(p[0], q[1], q[2]) + detail::det(q[0], p[1], q[2]) +
                                       detail::det(q[0], q[1], p[2]),
                                   size);
  };
  double mixed = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    mixed += detail::det(a[i], b[j], c[k]) + detail::det(a[i], c[j], b[k]);
  }
  std::array<double, 6> all = {detail::unless_rounding(detail::det(a[0], a[1], a[2]), far.prod()),
                               one_of(b, a, far2),
                               one_of(c, a, far2),
                               one_of(a, b, far.sum()),
                               detail::unless_rounding(mixed, 2 * far.sum()),
                               one_of(a, c, far.sum())};
  double largest = 0;
  for (const double coefficient : all) largest = std::max(largest, std::abs(coefficient));
  if (largest > 0)
    for (double& coefficient : all) coefficient /= largest;
  return {all[0], all[1], all[2], all[3], all[4], all[5]};
}

}  // namespace halfshade::test
