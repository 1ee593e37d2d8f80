#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "meshing/rays/visibility.h"
#include "solver/direct/direct_light.h"
#include "solver/elements/solution.h"

#include <span>
#include <vector>

namespace halfshade {

/// A solved scene, as far as gathering reads it.
struct SolvedElements {
  const SoundScene& scene;
  const ElementTable& elements;
  const Solution& solution;
};

/// Light that reaches points after at least one reflection, in W/m²: Σ over the elements of a
/// solution of the closed-form factor from point to element times the reflected radiosity ρH, times
/// the part of the element that rays find visible. `visibility` holds the scene's occluders. Points
/// may lie on surfaces. On all threads; if stopped, points not reached stay zero.
std::vector<Rgb> reflected_irradiance(const SolvedElements& solved,
                                      const VisibilityIndex& visibility,
                                      std::span<const SurfacePoint> points,
                                      const Progress& progress = {});

}  // namespace halfshade
