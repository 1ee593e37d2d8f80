#pragma once

#include "solver/direct/emitter_target.h"

#include <array>
#include <cstdint>
#include <vector>

namespace halfshade {

/// An emitter as triangles, to draw points of it.
struct RayEmitter {
  EmitterTarget target;
  int surface = 0, plane = 0;
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<double> reached;  ///< area of all triangles up to each
  Vec3 centroid;
  double radius = 0;  ///< of a sphere round the centroid

  double area() const { return reached.back(); }

  /// Evenly over all of it, for s and t in [0, 1].
  Vec3 point(double s, double t) const;
};

/// Of a surface; without triangles if it has no area.
RayEmitter make_ray_emitter(const SoundScene& scene, int id);

/// Form factor to all of an emitter that is far from the point and clearly above its horizon, but
/// for the share `far_error` of it; < 0 for others. A tenth of the time of a closed form.
double far_factor(const SurfacePoint& point, const RayEmitter& emitter);
inline constexpr double far_error = 0.1;

/// Random bits for rays from a position to an emitter: they follow from the direction of its
/// centre, in any unit of length.
std::uint64_t seed_of(const Vec3& position, const EmitterTarget& target);

}  // namespace halfshade
