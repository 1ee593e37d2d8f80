#pragma once

#include "meshing/core/types.h"

#include <span>
#include <vector>

namespace halfshade {

/// A right-handed orthonormal frame of a plane: e1 × e2 = normal.
struct PlaneFrame {
  Vec3 origin = Vec3::Zero();
  Vec3 e1 = Vec3::UnitX();
  Vec3 e2 = Vec3::UnitY();
  Vec3 normal = Vec3::UnitZ();

  Vec2 to_plane(const Vec3& p) const { return {e1.dot(p - origin), e2.dot(p - origin)}; }
  Vec3 to_space(const Vec2& q) const { return origin + q.x() * e1 + q.y() * e2; }
  /// Signed distance, positive in front.
  double height(const Vec3& p) const { return normal.dot(p - origin); }
  /// The nearest point of the plane. Elements share corners with their neighbours, so that points
  /// of theirs lie off their surface by as much as a file's digits put it off its corners; exact
  /// visibility is asked in its plane.
  Vec3 foot(const Vec3& p) const { return p - height(p) * normal; }
};

/// The area vector of a closed polygon: its length is the area, its direction the normal for a
/// counter-clockwise boundary (Newell). Works for non-convex and slightly non-planar polygons.
Vec3 area_vector(std::span<const Vec3> polygon);

/// Frame at the centroid of the corners with the area vector's direction as normal. e1 and e2
/// depend on the normal alone, so coplanar polygons that face the same way get parallel axes.
/// Precondition: the polygon's area is not zero.
PlaneFrame fit_plane(std::span<const Vec3> polygon);

/// Frame at a point with a normal of any positive length; e1 and e2 depend on the normal alone.
PlaneFrame make_frame(const Vec3& origin, const Vec3& normal);

/// The part of a convex polygon where (x − plane point)·normal ≥ 0 (Sutherland and Hodgman, 1974).
/// Points on the plane are kept; empty if nothing or only an edge or corner is left.
std::vector<Vec3> clip_to_front(std::span<const Vec3> polygon, const Vec3& plane_point,
                                const Vec3& normal);

}  // namespace halfshade
