#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/scene.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "solver/pipeline/stages.h"
#include "solver/pipeline/warnings.h"

#include <string>
#include <vector>

namespace halfshade {

class PreparedScene;
struct ContactLimit;

struct MeshOptions {
  DiscontinuityOptions events;
  int secondary = 0;  ///< how many of the brightest reflecting surfaces count as light sources, too
  /// Curves whose effect on the irradiance is below this share of its mean are left out, and
  /// conics are flattened accordingly; see mean_direct_irradiance. 0: the mesh is complete.
  double tolerance = 0;
  /// With a tolerance, no more elements than can be labelled with so much work, as
  /// DiscontinuityOptions has it; 0: a fifth of what a tolerance is worth.
  double label_work = 0;
  double max_length = 0;      ///< no element edge longer than this, scene units; 0: no limit
  double deviation = 0;       ///< of chords from conics, as DiscontinuityMeshOptions has it
  bool with_elements = true;  ///< false: find the curves only
};

/// A scene cut along the curves where its light breaks, not solved.
struct MeshResult {
  SoundScene scene;
  std::vector<Camera> cameras;
  std::string unit;
  Discontinuities found;
  ElementTable elements;        ///< empty without elements
  std::vector<Region> regions;  ///< row-major, one row an element, one column a source
  std::vector<Region> region;   ///< of each element, with respect to the strongest emitter there
  DiscontinuityMeshReport mesh;
  double irradiance_tolerance = 0;  ///< W/m², as used
  std::vector<StageReport> stages;
  std::vector<Warning> warnings;
  bool interrupted = false;  ///< stopped early: curves, elements or labels are missing
};

/// What contact lines may take of a mesh.
ContactLimit mesh_contact_limit();

/// Makes the scene sound, finds its discontinuities, meshes it along them and says what each
/// element sees of each source. Preconditions as for solve. Deterministic for any number of
/// threads.
MeshResult mesh_scene(const Scene& scene, const MeshOptions& options = {},
                      const Progress& progress = {});

/// The same for a scene that others use, too.
MeshResult mesh_scene(const PreparedScene& prepared, const MeshOptions& options = {},
                      const Progress& progress = {});

}  // namespace halfshade
