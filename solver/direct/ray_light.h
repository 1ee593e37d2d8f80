#pragma once

#include "meshing/core/progress.h"
#include "meshing/rays/visibility.h"
#include "solver/direct/direct_light.h"
#include "solver/elements/noisy_value.h"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace halfshade {

struct RayLightOptions {
  double deviation = 0;  ///< of a mean of two estimates, in W/m² (mean of the channels); > 0
  /// To one emitter from one point, ≥ 1: where it would take more, the visible part is looked for.
  double most_rays = 0;
};

struct RayIrradiance {
  std::vector<NoisyValue> at;  ///< each place, W/m²
  std::size_t rays = 0;        ///< traced for all of them, and what exact looks took, see in_rays
};

/// Direct light with rays to emitters, as many as a tolerance needs, where exactly visible parts
/// take longer. What an emitter would give unobstructed is exact; rays tell the share of it that
/// arrives. So light without a shadow is exact, and what is wholly hidden is dark. Of many weak
/// emitters a few are drawn, as often as they are strong, and a ray to each tells if its light
/// arrives: right in the mean, with noise that counts like that of other rays. Without a shadow
/// only that is left which differs in their colours or, far away, from a rough form factor. Where
/// they are so weak that groups of them are, groups are drawn by the most that they may give, and
/// then one of the group: a place looks at the lamps near it alone. That leaves noise without a
/// shadow, too, of a tenth of the deviation or so.
///
/// Rays end at points of a sequence of low discrepancy (Roberts 2018), shifted by random numbers
/// for each pair of point and emitter. These follow from the direction of the emitter, so that a
/// point has the same light in whatever batch and unit of length; where an emitter's outline
/// begins changes the noise. All calls may run concurrently. `scene`, `exact` and `visibility`
/// (owners are not used) are referred to.
class RayLight {
 public:
  /// Throws Error(contract) for options out of range.
  RayLight(const SoundScene& scene, const DirectLightIndex& exact,
           const VisibilityIndex& visibility, const RayLightOptions& options);
  ~RayLight();
  RayLight(RayLight&&) noexcept;

  /// Irradiance in W/m², twice by rays of its own, with the deviation asked for or less; with
  /// `slack`, one a place and ≥ 1, so many times that. On all threads; if stopped, places not
  /// reached are dark.
  RayIrradiance irradiance(std::span<const FieldPoint> places, std::span<const double> slack = {},
                           const Progress& progress = {}) const;

  /// Irradiance (mean of the channels) if nothing were in between: no less than there is, and more
  /// by a fifth at most, and a few hundredths of the deviation for each group of emitters.
  double unobstructed(const SurfacePoint& point) const;

  /// How many rays a point takes; an exact look counts as most_rays.
  double cost(const SurfacePoint& point) const;

  /// What a triangle of a surface sees of the emitter that would give its centre the most light, as
  /// far as some rays tell.
  Region region(const std::array<Vec3, 3>& triangle, const Vec3& normal, int surface) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace halfshade
