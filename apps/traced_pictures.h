#pragma once

#include "apps/render_pictures.h"
#include "io/picture/radiance_picture.h"
#include "meshing/core/sound_scene.h"

namespace halfshade {

/// What `render --method reference` and `classic` make.
struct TracedRendering {
  RadiancePicture radiance;
  std::vector<std::uint8_t> emits;  ///< 1 for pixels with an emitter
  RenderReport report;
};

/// Throws Error(usage) for names of mirrors that the scene does not have, and as chosen_camera.
TracedRendering render_traced(const SoundScene& scene, const std::vector<Camera>& cameras,
                              const RenderCommand& command, const Progress& progress);

/// The light of a solution by distributed rays (Cook, Porter and Carpenter 1984): a lens, a camera
/// that moves, glossy reflections of the solution in all surfaces, once. Throws as chosen_camera.
TracedRendering render_distributed(const ShadedMesh& mesh, const RenderCommand& command,
                                   const Progress& progress);

}  // namespace halfshade
