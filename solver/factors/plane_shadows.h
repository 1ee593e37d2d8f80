#pragma once

#include "solver/factors/shadow_cut.h"
#include "solver/factors/sight_scene.h"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace halfshade {

/// Outlines of bodies as seen from one point, each found when it is asked for.
class Outlines {
 public:
  /// `scene` must outlive it.
  explicit Outlines(const SightScene& scene)
      : scene_(scene), known_(scene.bodies.size()), stand_(scene.bodies.size(), 0) {}

  void move_to(const Vec3& point) {
    point_ = point;
    ++now_;
  }
  const Vec3& point() const { return point_; }
  /// A number of its own for each place.
  std::uint64_t now() const { return now_; }
  /// Edges between sides that look at the point and sides that do not, as pairs of vertices, with
  /// what looks at it to the left.
  using Edges = std::vector<std::array<int, 2>>;
  const Edges& of(int body);

 private:
  const SightScene& scene_;
  std::vector<Edges> known_;
  std::vector<char> is_front_;
  std::vector<std::uint64_t> stand_;  ///< where each was found; 0: nowhere
  std::uint64_t now_ = 0;
  Vec3 point_ = Vec3::Zero();
};

/// Shadows that convex things cast on one plane from one point: each is found when it is asked for,
/// and serves all surfaces in the plane.
class PlaneShadows {
 public:
  /// All must outlive it.
  PlaneShadows(const SightScene& scene, const PlaneFrame& frame, Outlines& outlines)
      : scene_(scene), frame_(frame), outlines_(outlines) {}

  /// Numbers of things by which they are asked for.
  int number_of_body(int body);
  int number_of_polygon(const Blocker& polygon);

  /// The point in the frame of the plane.
  const Vec3& point() {
    if (stand_ != outlines_.now()) move();
    return point_;
  }

  /// Of all that follows `point` must have been called. Which side of a thing the point sees: 1
  /// front, −1 back, 0: no shadow.
  int side(int thing) {
    Reach& reach = reaches_[at(thing)];
    if (reach.stand != stand_) reach = {stand_, side_of(shadows_[at(thing)]), false, {}};
    return reach.side;
  }
  /// What its shadow lies in, if it has any. `side` must have been called for it.
  const FlatBox& box(int thing) {
    Reach& reach = reaches_[at(thing)];
    if (!reach.has_box) find_box(shadows_[at(thing)], reach);
    return reach.box;
  }
  /// Its sides; the plane of a polygon is one of them.
  std::span<const ShadowSide> sides(int thing) {
    Shadow& shadow = shadows_[at(thing)];
    if (shadow.stand != stand_) find_sides(shadow, reaches_[at(thing)].side);
    return shadow.sides;
  }
  /// Where a polygon's plane meets this one: what lies behind it.
  const ShadowSide& plane_of(int polygon) const { return shadows_[at(polygon)].plane; }

 private:
  struct Shadow {
    std::uint64_t stand = 0;  ///< of sides
    std::vector<ShadowSide> sides;
    int body = -1;
    const Blocker* polygon = nullptr;
    ShadowSide plane = {};          ///< of the polygon, where it meets this one: front
    std::vector<double> x, y, z;    ///< corners in the frame
    std::array<double, 8> u, v, w;  ///< those of something that holds them, in the frame
    std::size_t around = 8;         ///< how many, even
  };

  struct Reach {
    std::uint64_t stand = 0;  ///< Outlines::now
    int side = 0;
    bool has_box = false;
    FlatBox box;
  };

  void move();
  int add(const Shadow& shadow, std::span<const Vec3> corners);
  int side_of(const Shadow& shadow) const;
  void find_box(const Shadow& shadow, Reach& reach) const;
  void find_open_box(const Shadow& shadow, FlatBox& box) const;
  void find_sides(Shadow& shadow, int side);
  void add_side(std::size_t from, std::size_t to, double sign, Shadow& shadow) const;
  Vec3 in_frame(const Vec3& p) const {
    const Vec3 d = p - frame_.origin;
    return {frame_.e1.dot(d), frame_.e2.dot(d), frame_.normal.dot(d)};
  }

  const SightScene& scene_;
  PlaneFrame frame_;
  Outlines& outlines_;
  std::uint64_t stand_ = 0;
  Vec3 point_ = Vec3::Zero();
  std::vector<Shadow> shadows_;
  std::vector<Reach> reaches_;  ///< of each shadow
  std::map<int, int> of_body_;
  std::map<const Blocker*, int> of_polygon_;
};

/// Shadows on all planes that are looked at from one surface.
class SharedShadows {
 public:
  /// `scene` must outlive it.
  explicit SharedShadows(const SightScene& scene)
      : scene_(scene), outlines_(scene), planes_(scene.surfaces.size()) {}

  void move_to(const Vec3& point) { outlines_.move_to(point); }
  Outlines& outlines() { return outlines_; }
  PlaneShadows& on_plane_of(int surface) {
    std::unique_ptr<PlaneShadows>& plane = planes_[at(scene_.surfaces[at(surface)].same_frame)];
    if (!plane)
      plane = std::make_unique<PlaneShadows>(scene_, scene_.surfaces[at(surface)].frame, outlines_);
    return *plane;
  }

 private:
  const SightScene& scene_;
  Outlines outlines_;
  std::vector<std::unique_ptr<PlaneShadows>> planes_;
};

}  // namespace halfshade
