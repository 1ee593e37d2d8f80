#pragma once

#include "meshing/core/progress.h"
#include "solver/direct/direct_light.h"
#include "solver/factors/factor_scene.h"
#include "solver/reflected/reflecting_scene.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

using Polygon3 = std::vector<Vec3>;
using Triangle3 = std::array<Vec3, 3>;

/// A surface as form factors need it.
struct SightSurface {
  Polygon3 outline;              ///< the outer ring
  std::vector<Polygon3> pieces;  ///< convex, together the surface
  PlaneFrame frame;
  LocalScale scale;
  double area = 0;  ///< squared scene units
  int plane = 0;
  std::vector<int> roots, cells;  ///< its coarse triangles, and the cells of space before them
};

/// A scene with all that is asked of it for form factors. All calls may run concurrently.
struct SightScene {
  std::vector<SightSurface> surfaces;
  ReflectingScene reflecting;
  DirectLightIndex light;  ///< exact point factors to any surface
};

/// `scene` must outlive the result. Cost: that of ReflectingScene and DirectLightIndex.
SightScene make_sight_scene(const SoundScene& scene, const Progress& progress = {});

enum class Sight { none, clear, partial };

/// What two surfaces can see of each other: nothing, for they lie behind each other's plane or in
/// different cells of space; everything, for nothing reaches into the hull of their parts that face
/// each other; or something in between. Cost: a shaft through the tree of the scene.
Sight sight_between(const SightScene& scene, int a, int b);

/// Roots that reach into the hull of a convex polygon on surface `a` and a convex part of surface
/// `b`, both before the plane of the other. Sorted.
std::vector<int> roots_between(const SightScene& scene, std::span<const Vec3> part, int a,
                               std::span<const Vec3> other, int b);

/// The parts of surface `a` that light from `b` may reach: triangles before the plane of `b`, and
/// in a cell of space that `b` is in. `is_all` tells whether none is left out because of its cell.
struct FacingTriangles {
  std::vector<Triangle3> triangles;
  bool is_all = true;
};
FacingTriangles facing_triangles(const SightScene& scene, int a, int b);

}  // namespace halfshade
