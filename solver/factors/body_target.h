#pragma once

#include "solver/factors/plane_shadows.h"
#include "solver/factors/points_across.h"
#include "solver/factors/shaded_target.h"
#include "solver/factors/sight_scene.h"
#include "solver/factors/view_cone.h"

#include <cstddef>
#include <span>
#include <vector>

namespace halfshade {

/// A convex body as a whole, looked at from points of one surface: what they see of it fills its
/// outline, whatever number of sides it has. Things in between cast cones, which are cut off one
/// after the other in a plane before the point.
class BodyTarget {
 public:
  /// `sides` are surfaces of the body that something may come between. `scene` must outlive it.
  /// Cost: that of blockers_between for each side.
  BodyTarget(const SightScene& scene, int surface, int body, std::span<const int> sides);

  /// Whether the surface sees the body from outside alone, and for all that comes between some
  /// plane has it on one side and the body on the other: so that it comes before the body, or lies
  /// behind it, as a whole.
  bool is_applicable() const { return is_applicable_; }
  double points_across(std::span<const Quad> quads) const;

  /// `hidden` and `is_dark` from the point where `outlines` are. False if that point is too near to
  /// the body, or sees it cut into too many parts.
  bool hidden_factor(Outlines& outlines, HiddenFactor& factor);

  /// At most what some point between some corners of the surface sees of the body, as a form
  /// factor: what it sees past one convex thing at least one of the corners does. About, for points
  /// may be nearer to it than the corners; 0 only if surely nothing. Precondition: the corners are
  /// no farther apart than they are off.
  double seen_at_most(std::span<const Vec3> corners, Outlines& outlines);

 private:
  /// What may come before the body: a body or a polygon, and a plane with the target behind it.
  struct Thing {
    int body;  ///< −1: a polygon
    const Blocker* polygon;
    ConvexBody::Side plane;
  };

  bool add(int body);
  bool add(const Blocker& polygon);
  bool stand_at(Outlines& outlines);
  bool find_view(const Vec3& point);
  bool find_outline(const Outlines::Edges& edges, const Vec3& point);
  bool find_cone(const Thing& thing, Outlines& outlines);
  bool hides_from_inside(const ConvexBody& body) const;
  void add_side(const Vec3& from, const Vec3& to, const Vec3& point);
  void cut_off_cone();
  double sum_of_edges();

  const SightScene& scene_;
  const SightSurface& own_;
  int body_;
  const ConvexBody& shape_;
  bool is_applicable_ = false;
  std::vector<Thing> things_;
  // Of one look, at a plane before the point that is 1 above it:
  PlaneFrame view_;  ///< its axes, with the point as the origin
  Vec3 normal_;      ///< of the surface that looks, in the view
  ViewCone cone_of_body_;
  std::vector<int> next_;      ///< along the outline, by vertex; −1: not on it
  std::vector<double> x_, y_;  ///< corners of the outline
  FlatBox box_;                ///< round it
  double nearness_ = 0;
  std::vector<ShadowSide> cone_, crossing_;
  ShadowCut cut_, horizon_;
  FlatEdges edges_;
};

}  // namespace halfshade
