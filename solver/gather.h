#pragma once

#include "meshing/core/progress.h"
#include "meshing/visibility.h"
#include "solver/direct_light.h"
#include "solver/solve.h"

#include <span>
#include <vector>

namespace halfshade {

/// Light that reaches points after at least one reflection, in W/m²: Σ over the elements of a
/// solution of the closed-form factor from point to element times the reflected radiosity ρH, times
/// the part of the element that rays find visible. `visibility` holds the scene's occluders. Points
/// may lie on surfaces. On all threads; if stopped, points not reached stay zero.
std::vector<Rgb> reflected_irradiance(const SolveResult& solved, const VisibilityIndex& visibility,
                                      std::span<const SurfacePoint> points,
                                      const Progress& progress = {});

}  // namespace halfshade
