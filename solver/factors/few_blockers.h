#pragma once

#include "solver/direct/direct_light.h"
#include "solver/factors/flat_parts.h"
#include "solver/factors/flat_sum.h"
#include "solver/factors/shaded_target.h"
#include "solver/factors/sight_scene.h"
#include "solver/factors/square_lattice.h"
#include "solver/factors/view_cone.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// Form factors from points of one surface to what is hidden of another, where only few convex
/// polygons come between: shadows are cut off the target one after the other, in the target's
/// plane, and what is cut off is summed. Ten times and more as quick as the search for silhouettes,
/// and exact to rounding, too; but the signature tells more apart than what bounds the hidden part.
class FewBlockers {
 public:
  /// Nothing is applicable if there is too much in between. `scene` must outlive it.
  FewBlockers(const SightScene& scene, int a, int b) : FewBlockers(scene, a, b, {}) {}
  /// With all `blockers` that reach into the hull of the two, which are convex; none: unknown.
  FewBlockers(const SightScene& scene, int a, int b, std::vector<int> blockers);

  bool is_applicable() const { return is_applicable_; }
  /// PointsAcross of lattices over parts of `a`.
  double points_across(std::span<const Quad> quads) const;
  /// Whether all that is in between are convex bodies before the target.
  bool has_only_solids() const { return shades_.empty(); }

  /// Convex bodies and polygons in between.
  std::size_t things() const { return solids_.size() + shades_.size(); }
  double width(std::size_t thing) const {
    return thing < solids_.size() ? solids_[thing].shape->width
                                  : shades_[thing - solids_.size()].blocker->width;
  }
  /// The polygons that bound one, as far as they reach in between.
  std::span<const Blocker* const> sides(std::size_t thing) const;
  /// What lies before the plane of `a`: corners of convex pieces.
  const Polygon3& target_corners() const { return target_in_space_; }

  /// What a thing alone hides from a point of `a`, as a form factor.
  double hidden_by(std::size_t thing, const Vec3& point);

  /// Mean of what a thing hides, and no thing before it does, from points that `factor` was asked
  /// for since the last `forget_found`.
  double found(std::size_t thing) const;
  void forget_found();

  /// From a point of `a`. False if shadows cut the target into too many parts.
  bool factor(const Vec3& point, HiddenFactor& factor);

  /// The same for points from which others look, too: quicker. Both must outlive the result.
  ShadedTarget shaded_target(SharedShadows& shadows, TargetMemory& memory) const;

  /// At most what some point of a triangle of `a` sees of the target, as a form factor: 0 only if
  /// surely nothing. What a convex thing hides from all corners it hides from all between them.
  double seen_at_most(const std::array<Vec3, 3>& cell);

 private:
  using Corner = FlatParts::Corner;
  /// A convex polygon in between.
  struct Shade {
    const Blocker* blocker;
    Vec2 a;  ///< with b and what follows: its plane in the target's
    double b, steepness;
    double least, most;  ///< heights of the target above its plane

    /// Of a point, if it is not on the plane but for rounding.
    double height(const Vec3& point) const;
  };
  /// A convex solid before the target.
  struct Solid {
    int body;
    const ConvexBody* shape;
    std::vector<const Blocker*> sides;
  };

  void add(const Blocker& blocker);
  bool make_shadow(const Shade& shade, double height, std::uint32_t border);
  bool make_shadow(const ConvexBody& body, std::uint32_t border);
  bool add_plane(const Vec3& normal, const Vec3& corner, std::uint32_t border);
  void stand_at(const Vec3& point);
  void look_from(const Vec3& point);
  bool cut_off_all(HiddenFactor& factor);
  FlatParts::Box reach_of_shadow(std::span<const Vec3> corners, bool is_polygon) const;
  void add_hidden(std::span<const Corner> part, HiddenFactor& factor) const;
  double sum_over(std::span<const Corner> part) const;
  double sum_over_parts() const;

  const SightSurface &own_, &target_;
  int target_id_;
  bool is_applicable_ = false;
  double nearness_ = 0;
  Vec3 normal_;      ///< of the surface that looks, in the target's frame
  FlatParts parts_;  ///< of the target that are not hidden
  Polygon3 target_in_space_;
  Ball target_ball_;
  std::vector<Solid> solids_;
  std::vector<Shade> shades_;
  // From one point:
  Vec3 point_;       ///< it,
  Vec3 from_frame_;  ///< from the origin of the target's frame,
  Vec3 in_frame_;    ///< and in the frame
  ViewCone view_;    ///< of the target
  Silhouette silhouette_;
  std::vector<FlatParts::HalfPlane> shadow_;  ///< of one thing in between
  std::vector<double> found_;                 ///< by thing, the sum over `looks_` points
  std::size_t looks_ = 0;
};

}  // namespace halfshade
