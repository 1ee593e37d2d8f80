#pragma once

#include "solver/direct/direct_light.h"

#include <functional>

namespace halfshade {

/// Exitance E in W/m² at a point of an emitter.
using ExitanceAt = std::function<Rgb(const Vec3&)>;

struct PaintedLightOptions {
  double tolerance = 1e-6;    ///< relative error of the irradiance, in (0, 1)
  int max_triangles = 20000;  ///< at which subdivision stops, ≥ 1
};

struct PaintedLight {
  Rgb irradiance = Rgb::Zero();  ///< H in W/m²
  double error = 0;              ///< estimate of its absolute error
  int triangles = 0;             ///< used
  bool converged = true;         ///< false if max_triangles was not enough
};

/// Irradiance from one emitter whose exitance varies, with exact visibility: the visible part is
/// cut into triangles, which are halved where the exitance varies until the error estimate is small
/// enough. On each triangle the exitance at its centroid counts with the exact form factor, and
/// only the difference from it is integrated by a rule; an even emitter is exact at once.
/// `exitance` is asked at points of the visible part only; the material's own exitance is not used.
/// Breaks in the paint cost many triangles, and the estimate may miss details smaller than a tenth
/// of the light.
PaintedLight painted_irradiance(const DirectLightIndex& index, const SoundScene& scene,
                                const SurfacePoint& point, int emitter, const ExitanceAt& exitance,
                                const PaintedLightOptions& options = {});

}  // namespace halfshade
