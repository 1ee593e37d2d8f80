#pragma once

#include "meshing/backprojection/visible_part.h"

#include <span>
#include <vector>

namespace halfshade {

/// Lambert's edge sum (Lambert 1760), written so that nothing cancels when the polygon is small or
/// far away. With unit vectors a, b to the ends of an edge and the angle θ between them, the sum of
/// θ/sin θ a×b over closed chains equals that of (a − c)×(b − c) + (θ/sin θ − 1) a×b for any c; if
/// c points to the polygon, no term is larger than its solid angle.
class EdgeSum {
 public:
  /// `towards` is any vector to the neighbourhood of the polygon except zero.
  explicit EdgeSum(const Vec3& towards);

  /// Adds the edge from a to b, both relative to the point. All edges together must form closed
  /// chains; their order does not matter.
  void add(const Vec3& a, const Vec3& b);

  /// Form factor from a surface element with this unit normal; positive for chains that run
  /// counter-clockwise seen from the point.
  double form_factor(const Vec3& normal) const;

 private:
  Vec3 minus_unit(const Vec3& a, double length) const;

  Vec3 towards_;
  double length_;
  Vec3 unit_;
  Vec3 sum_ = Vec3::Zero();
};

/// Form factor to the part of a polygon with holes above the point's horizon, whatever is in
/// between. The rings run counter-clockwise seen from the front, holes clockwise; 0 if the point is
/// not in front.
double unobstructed_factor(const Vec3& point, const Vec3& normal,
                           std::span<const std::vector<Vec3>> rings);

/// Form factor to what the pieces enclose.
double enclosed_factor(const Vec3& point, const Vec3& normal,
                       std::span<const BoundaryPiece> pieces);

}  // namespace halfshade
