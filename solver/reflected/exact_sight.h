#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/direct/direct_light.h"
#include "solver/reflected/reflecting_scene.h"

#include <memory>
#include <vector>

namespace halfshade {

/// A surface that something may see.
struct Sighted {
  int surface;
  bool is_clear;  ///< nothing can come between
};

/// What a point sees of a surface.
struct SeenPart {
  bool is_whole = false;    ///< all of it
  std::vector<Ring> rings;  ///< else the part, in the surface's frame, on their left
  double factor = 0;        ///< form factor to it, exact to rounding; 0 if nothing is seen
};

/// What points of elements see of surfaces, exactly. All calls may run concurrently.
class ExactSight {
 public:
  /// Both must outlive it.
  ExactSight(const SoundScene& scene, const ReflectingScene& reflecting);
  ~ExactSight();

  const SoundScene& scene() const;

  /// The roots of a surface.
  const std::vector<int>& roots(int surface) const;

  /// A place of a root, as a point in its surface's plane.
  SurfacePoint point_of(int root, const Vec3& place) const;

  /// The surfaces that points of a part of a root may see. Cost: a shaft for each that faces it.
  std::vector<Sighted> may_see(const std::array<Vec3, 3>& part, int root) const;

  /// The surfaces that a point, which may lie on one or not, may see; none is known to be clear.
  std::vector<Sighted> may_see(const SurfacePoint& point) const;

  /// Cost: grows with the silhouette edges in between, unless all is clear.
  void see(const SurfacePoint& point, const Sighted& target, SeenPart& seen) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace halfshade
