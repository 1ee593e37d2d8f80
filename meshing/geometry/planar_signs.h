#pragma once

#include "meshing/core/types.h"

#include <cmath>

namespace halfshade {

/// The signs that decide a triangulation, exact for any finite doubles. The inline parts answer
/// where rounding cannot change the sign (the first bounds of Shewchuk 1997).
int orientation_exactly(const Vec2& a, const Vec2& b, const Vec2& c);
int in_circle_exactly(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

/// +1 if a, b, c run counter-clockwise, −1 if clockwise, 0 on a line.
inline int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  const double determinant = left - right;
  constexpr double bound = (3 + 16 * 0x1p-53) * 0x1p-53;
  const double error = bound * (std::abs(left) + std::abs(right));
  if (determinant > error) return 1;
  if (determinant < -error) return -1;
  return orientation_exactly(a, b, c);
}

/// +1 if d lies inside the circle through a, b, c (counter-clockwise), −1 outside, 0 on it.
inline int in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 u = a - d, v = b - d, w = c - d;
  const double vw = v.x() * w.y(), wv = w.x() * v.y(), wu = w.x() * u.y(), uw = u.x() * w.y();
  const double uv = u.x() * v.y(), vu = v.x() * u.y();
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), ww = w.squaredNorm();
  const double determinant = uu * (vw - wv) + vv * (wu - uw) + ww * (uv - vu);
  const double permanent = uu * (std::abs(vw) + std::abs(wv)) + vv * (std::abs(wu) + std::abs(uw)) +
                           ww * (std::abs(uv) + std::abs(vu));
  constexpr double bound = (10 + 96 * 0x1p-53) * 0x1p-53;
  if (determinant > bound * permanent) return 1;
  if (determinant < -bound * permanent) return -1;
  return in_circle_exactly(a, b, c, d);
}

/// Whether two segments cross in a point inside both. Exact.
bool are_crossing(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

}  // namespace halfshade
