#pragma once

#include "meshing/geometry/ball.h"
#include "meshing/rays/occluders.h"

#include <optional>
#include <span>

namespace halfshade {

/// A ray in the coordinates of a RaySpace.
struct Ray {
  Vec3 origin;
  Vec3 direction;  ///< unit length
  double length = 0;

  Vec3 end() const { return origin + length * direction; }
};

/// Coordinates in which triangles lie in [−1, 1]³, where single precision does best.
struct RaySpace {
  Vec3 centre = Vec3::Zero();
  double scale = 1;        ///< (p − centre)·scale lies in [−1, 1]
  double enlargement = 0;  ///< of triangles, in scene units

  /// Holds all triangles, with room for rays that are off by rounding; in scene units.
  Ball ball() const;

  /// A segment, a little lengthened and without what lies far from all triangles. Nothing if it has
  /// no length, or nothing is left of it.
  std::optional<Ray> ray(const Vec3& from, const Vec3& to) const;

  /// The same for all that lies ahead of a finite point; `direction` has unit length.
  std::optional<Ray> ray_ahead(const Vec3& origin, const Vec3& direction) const;
};

/// The space of some triangles of a soup, given by their indices.
RaySpace make_ray_space(const TriangleSoup& soup, std::span<const int> triangles);

}  // namespace halfshade
