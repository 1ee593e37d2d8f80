#include "solver/pipeline/prepared_scene.h"

#include "meshing/rays/visibility.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"

#include <mutex>

namespace halfshade {

struct PreparedScene::Indices {
  std::once_flag opaque_once, direct_light_once, visibility_once;
  std::shared_ptr<const OpaqueScene> opaque;
  std::unique_ptr<const DirectLightIndex> direct_light;
  std::unique_ptr<const VisibilityIndex> visibility;
};

PreparedScene::PreparedScene(const Scene& scene, const Progress& progress)
    : cameras_(scene.cameras), unit_(scene.unit), indices_(std::make_unique<Indices>()) {
  validate(scene);
  require_emitter(scene);
  std::vector<StageReport> reports;
  Stages(reports).run("repair", [&] {
    progress("repair", 0);
    scene_ = make_sound(scene);
    return scene_.surfaces.size();
  });
  repair_ = reports.front();
}

PreparedScene::~PreparedScene() = default;

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
