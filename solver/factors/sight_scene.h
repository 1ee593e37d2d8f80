#pragma once

#include "meshing/core/progress.h"
#include "solver/direct/direct_light.h"
#include "solver/factors/convex_bodies.h"
#include "solver/factors/factor_scene.h"
#include "solver/factors/far_sight.h"
#include "solver/factors/joined_scene.h"
#include "solver/reflected/reflecting_scene.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

using Polygon3 = std::vector<Vec3>;
using Triangle3 = std::array<Vec3, 3>;

/// A convex polygon in the frame of its plane, counter-clockwise.
struct FlatPiece {
  Ring corners;
  std::vector<Vec2> sides;  ///< unit length, from each corner to the next
  double size = 0;          ///< the longest side
};

/// A surface as form factors need it.
struct SightSurface {
  Polygon3 outline;                  ///< the outer ring
  std::vector<Polygon3> rings;       ///< the outer one, then the holes
  std::vector<Polygon3> pieces;      ///< convex, together the surface
  std::vector<FarPiece> far_pieces;  ///< the same
  PlaneFrame frame;
  LocalScale scale;
  double area = 0;  ///< squared scene units
  int plane = 0;
  std::vector<int> roots, cells;  ///< its coarse triangles, and the cells of space before them
  int joined = 0;                 ///< what it is a part of
  int same_frame = 0;             ///< the first surface with this frame, to the bit
  // Of surfaces that are not all of what they are a part of:
  std::vector<FlatPiece> flat_pieces;  ///< in the frame
  double magnitude_in_plane = 0;       ///< the largest coordinate of what it is a part of
};

/// A convex polygon that hides things.
struct Blocker {
  Polygon3 corners;
  Vec3 normal;          ///< unit length
  double rounding = 0;  ///< of heights above its plane
  Ball ball;            ///< round it
  double width = 0;     ///< least distance from a side to the farthest corner,
  Vec3 along;           ///< direction of that side, unit length,
  double length = 0;    ///< and how far it reaches along it
  double area = 0;      ///< squared scene units
  int body = -1;        ///< that it is a side of; −1: none
};

/// A scene with all that is asked of it for form factors. All calls may run concurrently.
struct SightScene {
  std::vector<SightSurface> surfaces;
  ReflectingScene reflecting;
  JoinedScene joined;       ///< what hides things
  VisibilityIndex between;  ///< its triangles, each its own owner
  std::vector<Blocker> blockers;
  std::vector<ConvexBody> bodies;
  std::vector<int> body_of;     ///< joined surface → the body that it is a side of; −1: none
  std::vector<int> blocker_of;  ///< triangle of `between` → what it is a part of
  DirectLightIndex light;       ///< what points see of joined surfaces, exactly
};

/// The body that a surface is a side of; −1: none.
inline int body_with(const SightScene& scene, int surface) {
  return scene.body_of[at(scene.surfaces[at(surface)].joined)];
}

/// `scene` must outlive the result. Cost: that of ReflectingScene and DirectLightIndex.
SightScene make_sight_scene(const SoundScene& scene, const Progress& progress = {});

enum class Sight { none, clear, partial };

/// Whether neither lies behind the other's plane, and both are in one cell of space.
bool may_see(const SightScene& scene, int a, int b);

/// What two surfaces can see of each other: nothing, for they lie behind each other's plane or in
/// different cells of space, or one convex polygon hides all from all; everything, for nothing
/// reaches into the hull of their parts that face each other; or something in between. Cost: a
/// shaft through the tree of the scene.
Sight sight_between(const SightScene& scene, int a, int b);

/// Triangles of SightScene::between that may lie between two polygons. Sorted.
using Between = std::vector<int>;

/// The same of two convex polygons in the planes of surfaces `a` and `b`, whatever their cells.
/// `known`, if any, are triangles among which all lie that are between them; those that do are left
/// in `found` if sight is partial.
Sight sight_between_convex(const SightScene& scene, std::span<const Vec3> part, int a,
                           std::span<const Vec3> other, int b, const Between* known,
                           Between& found);

/// Triangles of SightScene::between that reach into the hull of a convex polygon on surface `a` and
/// a convex part of surface `b`, both before the plane of the other. Sorted.
std::vector<int> triangles_between(const SightScene& scene, std::span<const Vec3> part, int a,
                                   std::span<const Vec3> other, int b);

/// What of SightScene::blockers reaches into the hull of any two convex pieces of surfaces `a` and
/// `b`, as far as these lie before the plane of the other. Rising.
std::vector<int> blockers_between(const SightScene& scene, int a, int b);

/// Whether light from `b` may reach all triangles of surface `a`, as cells of space go.
bool in_all_cells_of(const SightScene& scene, int a, int b);

/// The parts of surface `a` that light from `b` may reach: triangles before the plane of `b`, and
/// in a cell of space that `b` is in. `is_all` tells whether none is left out because of its cell.
struct FacingTriangles {
  std::vector<Triangle3> triangles;
  bool is_all = true;
};
FacingTriangles facing_triangles(const SightScene& scene, int a, int b);

/// Whether two surfaces, of which one at least lies in cells of space that the other does not see,
/// see all of each other that lies in the others: as a floor and the inside of what stands on it.
bool is_clear_in_cells(const SightScene& scene, int a, int b);

}  // namespace halfshade
