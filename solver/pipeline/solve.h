#pragma once

#include "meshing/core/light_source.h"
#include "meshing/core/progress.h"
#include "meshing/core/scene.h"
#include "meshing/core/sound_scene.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "meshing/patches/element_table.h"
#include "solver/adapt/adaptive_field.h"
#include "solver/elements/element_field.h"
#include "solver/elements/solution.h"
#include "solver/elements/straight_cut.h"
#include "solver/heat/heat.h"
#include "solver/pipeline/goal.h"
#include "solver/pipeline/solve_options.h"
#include "solver/pipeline/stages.h"
#include "solver/pipeline/warnings.h"
#include "solver/reflected/reflected_light.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace halfshade {

class PreparedScene;

/// How constant elements were divided.
struct SubdivisionReport {
  int patches = 0;            ///< there were at first; 0: nothing was to be divided
  std::vector<int> elements;  ///< after each round
};

/// What came of a scene's heat beside its light; see solve_net_exchange.
struct FoundHeat {
  Eigen::ArrayXd escaped_power;  ///< what space gets net in each band, W (for lengths in metres)
  /// K, of each face whose temperature several bands tell together, else NaN; empty if of none.
  std::vector<double> face_temperature;
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
  std::shared_ptr<PatchMesh> patches;  ///< of the elements, if they can be split further
  Solution solution;                   ///< means over the elements
  /// Polynomials on the elements, if they are not constant: direct and all irradiance, W/m².
  ElementField direct, irradiance;
  /// If asked for: the parts of `irradiance` that were reflected once, twice, …, W/m².
  std::vector<ElementField> bounces;
  int most_bounces = -1;      ///< light that arrives after at most so many reflections; −1: all
  bool interpolated = false;  ///< they are of constant elements, see interpolated_field
  SubdivisionReport subdivision;
  AdaptiveFieldReport refinement;  ///< of direct light
  ReflectedReport reflected;
  std::optional<ReflectedLight> reflected_light;  ///< if it was solved for as polynomials
  /// What each element sees of each emitter, if asked for: row-major, one row an element, one
  /// column an emitter.
  std::vector<Region> regions;
  std::vector<LightSource> emitters;  ///< in the order of the columns
  std::vector<StageReport> stages;
  std::vector<Warning> warnings;
  ExchangeReport exchange;
  RadiosityReport radiosity;
  /// Estimated, of the irradiance in the L2 norm: of the mesh, and of the solver's residual. With a
  /// goal: of that.
  double relative_error = 0;
  double lamp_tolerance = 0;       ///< that lamps with pictures were cut for; 0: there are none
  StraightCut straight;            ///< of `irradiance`, for files; empty before cut_for_files
  Heat heat;                       ///< what is known of temperatures; see solve_net_exchange
  FoundHeat found_heat;            ///< empty unless it was solved for
  std::optional<GoalResult> goal;  ///< if one was asked for
  std::string not_reached;         ///< why the accuracy asked for was not; empty if it was
  bool interrupted = false;        ///< stopped early; see compute_exchange for factors not reached
};

/// The main job: makes the scene sound, meshes it along its discontinuities, computes form factors,
/// solves for radiosity. Preconditions: the scene is valid and has an emitter. Throws
/// Error(invalid_input) and Error(too_large). Deterministic for any number of threads.
SolveResult solve(const Scene& scene, const SolveOptions& options = {},
                  const Progress& progress = {});

/// The same for a scene that others use, too.
SolveResult solve(const PreparedScene& prepared, const SolveOptions& options = {},
                  const Progress& progress = {});

}  // namespace halfshade
