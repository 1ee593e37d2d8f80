#pragma once

#include "meshing/core/progress.h"
#include "meshing/visible_part.h"

#include <span>
#include <vector>

namespace halfshade {

/// A point on a surface.
struct SurfacePoint {
  Vec3 position;
  Vec3 normal;  ///< unit length; light from behind it does not count
};

/// The light that reaches a point straight from one emitter, per unit of exitance.
struct PointFactor {
  double visible = 0;  ///< form factor to the visible part: exactly 0 in umbra
  double unobstructed =
      0;  ///< form factor to the whole emitter above the horizon; equal to `visible` if lit
  Region region = Region::away;
  std::uint64_t signature = 0;
};

/// The same with derivatives with respect to the point, for a fixed normal.
struct PointFactorDerivatives {
  PointFactor factor;
  Vec3 gradient = Vec3::Zero();                       ///< ∂F/∂x
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< ∂²F/∂x²
};

struct DirectLight {
  Rgb irradiance = Rgb::Zero();  ///< H in W/m²
  /// Share of the light that would arrive unobstructed, weighted with the emitters' exitance (mean
  /// of the channels): 0 in umbra of all, 1 if nothing is hidden; 1 where no emitter lies above the
  /// horizon.
  double visible = 1;
  Region region =
      Region::away;  ///< with respect to the emitter that gives the most unobstructed light
};

/// Exact direct light of a scene: no sampling, correct to rounding. Concurrent calls need a copy
/// each of the finder inside, which batches take care of.
class DirectLightIndex {
 public:
  explicit DirectLightIndex(const SoundScene& scene);
  ~DirectLightIndex();
  DirectLightIndex(DirectLightIndex&&) noexcept;
  DirectLightIndex& operator=(DirectLightIndex&&) noexcept;

  /// The receivers with E > 0.
  std::span<const int> emitters() const;

  /// Form factor from a point to the visible part of one emitter.
  PointFactor factor(const SurfacePoint& point, int emitter) const;
  PointFactorDerivatives factor_derivatives(const SurfacePoint& point, int emitter) const;

  /// Irradiance at points from all emitters, on all threads; the result does not depend on their
  /// number.
  std::vector<DirectLight> irradiance(std::span<const SurfacePoint> points,
                                      const Progress& progress = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace halfshade
