#pragma once

#include "solver/direct/emitter_target.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// cos θ cos θ' / r² of a way from a point to an emitter.
double light_along(const SurfacePoint& point, const EmitterTarget& target, const Vec3& way);

/// True if light at a point from equal areas of an emitter differs so little that few rays to it
/// tell its mean. `factor`: form factor of all its area.
bool is_even(const SurfacePoint& point, const EmitterTarget& target, double area, double factor);

/// A triangle of an emitter above a point's horizon, so narrow as the point sees it that its plane
/// through the unit vectors to its corners is close to the sphere of directions.
struct EmitterPart {
  std::array<Vec3, 3> ways;         ///< unit vectors from the point to the corners
  std::array<double, 3> distances;  ///< of the corners; > 0
  std::array<double, 3> heights;    ///< cosines of the ways to the point's normal; ≥ 0
  double middle = 0;                ///< distance of the plane's middle from the point; ≤ 1
  double light = 0;                 ///< nearly in proportion to its form factor
};

/// Appends the parts of an emitter's triangles that give light to a point which is in front of the
/// emitter, however close, and whose horizon may cut it.
void add_parts(const SurfacePoint& point, std::span<const std::array<Vec3, 3>> triangles,
               std::vector<EmitterPart>& parts);

/// A point of an emitter, drawn by the light that comes from it.
struct LightPoint {
  Vec3 way;       ///< from the point that the light comes to
  double weight;  ///< light along it over its likelihood, in units of its own; even within 2.6
};

/// Draws points of an emitter about as likely as the light that comes from them. Its parts, one at
/// least, are referred to.
class LightDraw {
 public:
  explicit LightDraw(std::span<const EmitterPart> parts);

  /// For s and t in [0, 1]: where pairs of them fill a square evenly, the points do so, too.
  LightPoint point(double s, double t) const;

 private:
  std::span<const EmitterPart> parts_;
  double light_ = 0;  ///< of all
};

}  // namespace halfshade
