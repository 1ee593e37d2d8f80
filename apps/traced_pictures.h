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

}  // namespace halfshade
