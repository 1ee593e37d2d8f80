#pragma once

#include "meshing/core/progress.h"
#include "solver/pipeline/prepared_scene.h"

#include <functional>

namespace halfshade {

/// W/m²: the mean over all that light of emitters reaches of its brightness, from exact values
/// where up to a hundred rays end that leave the emitters as their light does. Places are as dense
/// as light is strong there, so that it is the harmonic mean over them. For scenes of which so
/// little is lit that other places miss it; fewer rays where looks take very long. 0 if none ends
/// in front of a surface.
double mean_over_lit_area(const PreparedScene& prepared,
                          const std::function<double(const Rgb&)>& brightness,
                          const Progress& progress = {});

}  // namespace halfshade
