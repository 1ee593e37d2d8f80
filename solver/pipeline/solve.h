#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/scene.h"
#include "meshing/core/sound_scene.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "meshing/patches/element_table.h"
#include "solver/elements/solution.h"
#include "solver/exchange/exchange.h"
#include "solver/linear/radiosity.h"
#include "solver/pipeline/stages.h"

#include <cstddef>
#include <string>
#include <vector>

namespace halfshade {

enum class DirectLightBy {
  automatic,  ///< exact, unless emitters are most of the scene, as in a furnace
  exact,      ///< closed forms on exactly visible parts at points of each element
  matrix      ///< the same form factors as reflected light
};

struct SolveOptions {
  int elements =
      8000;  ///< about how many elements to mesh the scene with, ≥ 1; used if max_length is 0
  double max_length = 0;        ///< longest element edge in scene units; 0: derived from `elements`
  int max_elements = 40000;     ///< refuse to make more; memory grows with the square
  bool discontinuities = true;  ///< mesh along the lines where the light breaks
  DiscontinuityOptions events;  ///< which lines to look for
  int secondary = 0;  ///< look for those of this many of the brightest reflecting surfaces, too
  /// Lines whose effect on the irradiance is below this share of its mean are left out.
  double tolerance = 0.01;
  DirectLightBy direct_light = DirectLightBy::automatic;
  int direct_points = 6;  ///< points an element at which direct light is exact, 1…12
  ExchangeOptions exchange;
  RadiosityOptions radiosity;
};

/// A solved scene and how it came about.
struct SolveResult {
  SoundScene scene;
  std::vector<Camera> cameras;
  std::string unit;
  DiscontinuityReport discontinuities;
  std::size_t curves = 0;              ///< found, after merging
  DiscontinuityMeshReport mesh;        ///< how many of them the mesh has edges along
  double discontinuity_tolerance = 0;  ///< share of the mean irradiance, as used
  ElementTable elements;
  Solution solution;
  std::vector<StageReport> stages;
  ExchangeReport exchange;
  RadiosityReport radiosity;
  double relative_error = 0;  ///< estimated, of the irradiance in the L2 norm
  bool interrupted = false;   ///< stopped early: factors not reached count as zero
};

/// The main job: makes the scene sound, meshes it along its discontinuities, computes form factors,
/// solves for radiosity. Preconditions: the scene is valid and has an emitter. Throws
/// Error(invalid_input) and Error(too_large). Deterministic for any number of threads.
SolveResult solve(const Scene& scene, const SolveOptions& options = {},
                  const Progress& progress = {});

}  // namespace halfshade
