#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/reference/traced_picture.h"

namespace halfshade {

/// A picture of all light by random walks, see reference_light: what is seen ahead, fronts only,
/// sends E + ρ H over π, H of one walk from there. Throws as reference_light and trace_pixels.
TracedPicture reference_picture(const SoundScene& scene, const CameraRays& camera,
                                const PixelOptions& options, const Progress& progress = {});

}  // namespace halfshade
