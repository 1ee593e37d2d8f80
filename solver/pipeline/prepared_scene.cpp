#include "solver/pipeline/prepared_scene.h"

#include "meshing/core/error.h"
#include "meshing/rays/visibility.h"
#include "meshing/repair/repair.h"
#include "meshing/repair/repair_sentence.h"
#include "solver/direct/direct_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

namespace halfshade {

struct PreparedScene::Indices {
  std::once_flag opaque_once, direct_light_once, visibility_once;
  std::shared_ptr<const OpaqueScene> opaque;
  std::unique_ptr<const DirectLightIndex> direct_light;
  std::unique_ptr<const VisibilityIndex> visibility;
};

bool has_emitter(const SoundScene& scene) {
  return std::any_of(scene.surfaces.begin(), scene.surfaces.end(), [&](const Surface& surface) {
    return (scene.materials[at(surface.material)].exitance > 0).any();
  });
}

namespace {

/// Light beyond these exitances, in W/m², would over- or underflow on its way.
constexpr double weakest = 1e-200, strongest = 1e200;

/// What emits must do so as doubles can follow.
void require_exitances(const Scene& scene, const SoundScene& sound) {
  for (const Surface& surface : sound.surfaces)
    for (const double exitance : sound.materials[at(surface.material)].exitance) {
      if (exitance > strongest || (exitance > 0 && exitance < weakest))
        throw Error(
            ErrorCode::invalid_input, scene.source,
            fmt::format("material '{}' emits {} W/m²; numbers hold only what lies between "
                        "{} and {}, so give the exitances in another unit",
                        sound.materials[at(surface.material)].name, exitance, weakest, strongest));
    }
}

/// Something that emits must be left of the scene.
void require_light(const Scene& scene, const SoundScene& sound) {
  if (has_emitter(sound)) return;
  require_emitter(scene);
  for (const Repair& repair : sound.repairs)
    for (const int face : repair.faces)
      if ((scene.materials[at(scene.faces[at(face)].material)].exitance > 0).any())
        throw Error(ErrorCode::invalid_input, scene.source,
                    fmt::format("nothing that emits light is left of the scene: {}",
                                sentence(repair, sound)));
  throw Error(ErrorCode::invalid_input, scene.source,
              "nothing that emits light is left of the scene after its repair");
}

}  // namespace

PreparedScene::PreparedScene(const Scene& scene, const Progress& progress,
                             const RepairOptions& options, Emitters emitters)
    : cameras_(scene.cameras), unit_(scene.unit), indices_(std::make_unique<Indices>()) {
  validate(scene);
  std::vector<StageReport> reports;
  Stages(reports).run("repair", [&] {
    progress("repair", 0);
    scene_ = make_sound_in_any_order(scene, options);
    return scene_.surfaces.size();
  });
  repair_ = reports.front();
  require_exitances(scene, scene_);
  if (emitters == Emitters::required) require_light(scene, scene_);
  warnings_ = repair_warnings(scene, scene_);
}

PreparedScene::PreparedScene(SoundScene scene)
    : scene_(std::move(scene)), indices_(std::make_unique<Indices>()) {}

PreparedScene::~PreparedScene() = default;
PreparedScene::PreparedScene(PreparedScene&&) noexcept = default;

const OpaqueScene& PreparedScene::opaque() const {
  std::call_once(indices_->opaque_once,
                 [&] { indices_->opaque = std::make_shared<const OpaqueScene>(scene_); });
  return *indices_->opaque;
}

const DirectLightIndex& PreparedScene::direct_light() const {
  opaque();
  std::call_once(indices_->direct_light_once, [&] {
    indices_->direct_light = std::make_unique<const DirectLightIndex>(scene_, indices_->opaque);
  });
  return *indices_->direct_light;
}

const VisibilityIndex& PreparedScene::visibility() const {
  std::call_once(indices_->visibility_once, [&] {
    indices_->visibility = std::make_unique<const VisibilityIndex>(occluders(scene_));
  });
  return *indices_->visibility;
}

}  // namespace halfshade
