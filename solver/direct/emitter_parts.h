#pragma once

#include "solver/direct/emitter_target.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// cos θ cos θ' / r² of a way from a point to an emitter.
double light_along(const SurfacePoint& point, const EmitterTarget& target, const Vec3& way);

/// A triangle of an emitter as a point sees it.
struct EmitterPart {
  std::array<Vec3, 3> triangle;
  double factor = 0;  ///< form factor if nothing is in between
};

/// True if light at a point from equal areas of an emitter differs so little that few rays to it
/// tell its mean. `factor`: form factor of all its area.
bool is_even(const SurfacePoint& point, const EmitterTarget& target, double area, double factor);

/// Cuts triangles of an emitter in halves until each is even for a point or its factor is less than
/// `negligible`, and appends those with a factor. False, with nothing appended, where it takes too
/// many: very close to the emitter.
bool cut_evenly(const SurfacePoint& point, const EmitterTarget& target,
                std::span<const std::array<Vec3, 3>> triangles, double negligible,
                std::vector<EmitterPart>& parts);

/// A point of an emitter, drawn by the light that comes from it.
struct LightPoint {
  Vec3 position;
  double weight;  ///< of the light along the way to it; 1 in the mean
};

/// Points of an emitter's triangles, about as likely as the light that would come from them,
/// however close it is and where the horizon cuts it; `weight` makes up for the rest. Goes down
/// halves of triangles until light from one is even. `pairs`, in [0, 1], one a point: where they
/// fill a square evenly, the points do so, too; changed. Appends none if no light comes.
void add_points_by_light(const SurfacePoint& point, const EmitterTarget& target,
                         std::span<const std::array<Vec3, 3>> triangles,
                         std::span<std::array<double, 2>> pairs, std::vector<LightPoint>& points);

}  // namespace halfshade
