#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/scene.h"
#include "meshing/core/sound_scene.h"
#include "meshing/repair/repair.h"
#include "solver/pipeline/stages.h"
#include "solver/pipeline/warnings.h"

#include <memory>
#include <string>
#include <vector>

namespace halfshade {

class DirectLightIndex;
class OpaqueScene;
class VisibilityIndex;

/// A scene made sound, and what is built on it once, when it is first asked for. All calls may run
/// concurrently.
class PreparedScene {
 public:
  /// Throws Error(invalid_input) unless the scene is valid and has an emitter that the repair
  /// leaves, of an exitance between 1e-200 and 1e200 W/m²; see validate and make_sound.
  explicit PreparedScene(const Scene& scene, const Progress& progress = {},
                         const RepairOptions& options = {});
  ~PreparedScene();

  const SoundScene& scene() const { return scene_; }
  const std::vector<Camera>& cameras() const { return cameras_; }
  const std::string& unit() const { return unit_; }
  /// What making it sound took.
  const StageReport& repair() const { return repair_; }
  /// Of what it changed.
  const std::vector<Warning>& warnings() const { return warnings_; }

  const OpaqueScene& opaque() const;
  const DirectLightIndex& direct_light() const;  ///< on the same opaque scene
  const VisibilityIndex& visibility() const;     ///< of the scene's occluders

 private:
  struct Indices;

  SoundScene scene_;
  std::vector<Camera> cameras_;
  std::string unit_;
  StageReport repair_;
  std::vector<Warning> warnings_;
  std::unique_ptr<Indices> indices_;
};

/// What every result of a pipeline begins with: the scene, and its repair as the first stage.
template <class Result>
Result begin_result(const PreparedScene& prepared) {
  Result result;
  result.scene = prepared.scene();
  result.cameras = prepared.cameras();
  result.unit = prepared.unit();
  result.stages = {prepared.repair()};
  result.warnings = prepared.warnings();
  return result;
}

}  // namespace halfshade
