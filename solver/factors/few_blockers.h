#pragma once

#include "solver/direct/direct_light.h"
#include "solver/factors/sight_scene.h"

#include <cstdint>
#include <vector>

namespace halfshade {

/// Form factors from points of one surface to what is seen of another, where only few convex
/// polygons come between: shadows are cut off the target one after the other, in the target's
/// plane. Five to ten times as quick as the search for silhouettes, and exact to rounding, too; but
/// the signature tells more apart than what bounds the visible part.
class FewBlockers {
 public:
  /// Nothing is applicable if there is too much in between. `scene` must outlive it.
  FewBlockers(const SightScene& scene, int a, int b);

  bool is_applicable() const { return is_applicable_; }

  /// From a point of `a`. False if shadows cut the target into too many parts.
  bool factor(const SurfacePoint& point, PointFactor& factor);

 private:
  /// A corner of a convex part of the target, and what its edge from there lies on.
  struct Corner {
    Vec2 at;
    std::uint32_t border;
  };
  using Part = std::vector<Corner>;
  /// Where a·x + b ≤ 0, in the target's plane; a of unit length.
  struct HalfPlane {
    Vec2 a;
    double b;
    std::uint32_t border;
    double height(const Vec2& p) const { return a.dot(p) + b; }
  };
  /// A convex polygon in between, with its own plane in that of the target: negative in front.
  struct Shade {
    const Blocker* blocker;
    Vec2 a;
    double b, steepness;
    double least, most;  ///< heights of the target above its plane
  };

  void add(const Blocker& blocker);
  bool make_shadow(const Shade& shade, const SurfacePoint& point, double height);
  bool make_shadow(const ConvexBody& body, const SurfacePoint& point, std::uint32_t border);
  bool add_plane(const Vec3& normal, const Vec3& point, double size, std::uint32_t border);
  void cut_off_shadow();
  void cut_off_shadow(Part& part);
  double snapped(double height) const { return std::abs(height) < nearness_ ? 0 : height; }
  void split(const Part& part, const HalfPlane& plane, Part& inside, Part& outside) const;

  const SightSurface& target_;
  bool is_applicable_ = false;
  double nearness_ = 0;
  std::vector<Part> target_parts_;
  std::vector<const ConvexBody*> bodies_;  ///< before the target
  std::vector<Shade> shades_;
  std::vector<bool> is_front_;
  std::vector<HalfPlane> shadow_;  ///< of one shade from one point
  std::vector<Part> parts_, next_, cut_;
  Part inside_, outside_, rest_;
};

}  // namespace halfshade
