#pragma once

#include "meshing/core/types.h"

#include <cmath>
#include <cstdint>

namespace halfshade {

/// A point as seen from a fixed eye. `rank` orders the infinitesimal displacements that break ties:
/// distinct points need distinct ranks, and the same point must always come with the same rank.
struct SeenPoint {
  Vec3 position;
  Vec3 direction;  ///< position − eye, rounded
  std::int64_t rank = 0;
};

/// ±1: whether a, b, c run counter-clockwise (+1) or clockwise as seen from the eye. Exact for the
/// positions as given; points that lie in a plane with the eye are moved apart by infinitesimal
/// amounts that depend on their ranks alone (simulation of simplicity; Edelsbrunner and Mücke
/// 1990), so that all answers about one eye belong to one scene in general position. The eye itself
/// stays where it is. Precondition: three distinct points.
int turn_exactly(const Vec3& eye, const SeenPoint& a, const SeenPoint& b, const SeenPoint& c);

/// The same in doubles, or 0 where the rounding error may change the sign (Shewchuk's first bound
/// for orient3d, 1997).
inline int clear_turn(const SeenPoint& a, const SeenPoint& b, const SeenPoint& c) {
  const Vec3 &p = a.direction, &q = b.direction, &r = c.direction;
  const double qr_x = q.y() * r.z(), rq_x = q.z() * r.y();
  const double qr_y = q.z() * r.x(), rq_y = q.x() * r.z();
  const double qr_z = q.x() * r.y(), rq_z = q.y() * r.x();
  const double determinant = p.x() * (qr_x - rq_x) + p.y() * (qr_y - rq_y) + p.z() * (qr_z - rq_z);
  const double permanent = std::abs(p.x()) * (std::abs(qr_x) + std::abs(rq_x)) +
                           std::abs(p.y()) * (std::abs(qr_y) + std::abs(rq_y)) +
                           std::abs(p.z()) * (std::abs(qr_z) + std::abs(rq_z));
  constexpr double bound = (7 + 56 * 0x1p-53) * 0x1p-53;
  if (determinant > bound * permanent) return -1;
  return determinant < -bound * permanent ? 1 : 0;
}

}  // namespace halfshade
