#pragma once

#include "meshing/core/error.h"
#include "meshing/core/progress.h"
#include "meshing/core/scene.h"
#include "meshing/core/sound_scene.h"
#include "meshing/repair/repair.h"
#include "solver/pipeline/stages.h"
#include "solver/pipeline/warnings.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace halfshade {

class DirectLightIndex;
class OpaqueScene;
class VisibilityIndex;

/// Whether something in a scene has to emit.
enum class Emitters { required, optional };

/// A scene made sound, and what is built on it once, when it is first asked for. All calls may run
/// concurrently.
class PreparedScene {
 public:
  /// Throws Error(invalid_input) unless the scene is valid and has an emitter that the repair
  /// leaves, where one is required, and all of an exitance between 1e-200 and 1e200 W/m²; see
  /// validate and make_sound.
  explicit PreparedScene(const Scene& scene, const Progress& progress = {},
                         const RepairOptions& options = {}, Emitters emitters = Emitters::required);
  /// Of a scene that is sound already.
  explicit PreparedScene(SoundScene scene);
  ~PreparedScene();
  PreparedScene(PreparedScene&&) noexcept;

  const SoundScene& scene() const { return scene_; }
  const std::vector<Camera>& cameras() const { return cameras_; }
  const std::string& unit() const { return unit_; }
  /// What making it sound took.
  const StageReport& repair() const { return repair_; }
  /// Of what it changed.
  const std::vector<Warning>& warnings() const { return warnings_; }
  /// Puts another one before them.
  void warn_first(const Warning& warning) { warnings_.insert(warnings_.begin(), warning); }

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

/// Whether any surface of a scene emits.
bool has_emitter(const SoundScene& scene);

/// How many elements contact lines may take, and what is said if they take more.
struct ContactLimit {
  double most_elements = HUGE_VAL;
  Warning warning;  ///< no sentence: none
};

/// Calls `use` with the scene prepared. Where contact lines take more elements than allowed, or
/// `use` or the repair throws Error(too_large), once more with a scene without them: what nobody
/// modelled, but a scanner or a random generator made, cuts through itself everywhere.
template <class Use>
auto use_prepared(const Scene& scene, const ContactLimit& limit, const Progress& progress, Use use,
                  Emitters emitters = Emitters::required) {
  // Each piece is a side of two elements, and each element has three.
  const double most_contacts = 1.5 * limit.most_elements;
  try {
    return use(PreparedScene(scene, progress,
                             {.most_contacts = most_contacts, .most_surfaces = limit.most_elements},
                             emitters));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::too_large) throw;
  }
  PreparedScene prepared(scene, progress, {.contacts = false}, emitters);
  if (!limit.warning.sentence.empty()) prepared.warn_first(limit.warning);
  return use(std::move(prepared));
}

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
