#pragma once

#include "meshing/core/light_source.h"
#include "solver/pipeline/prepared_scene.h"

#include <string>
#include <vector>

namespace halfshade {

/// The `count` surfaces that reflect most power in a solution on a coarse mesh, brightest power
/// first, emitters not among them; their exitance is what they reflect (mean of the surface,
/// strongest channel). Cost: a solution with about 1000 elements.
std::vector<LightSource> secondary_sources(const PreparedScene& prepared, int count,
                                           const Progress& progress = {});

/// What to find discontinuities of: emitters, and `secondary` secondary sources.
std::vector<LightSource> all_sources(const PreparedScene& prepared, int secondary,
                                     const Progress& progress = {});

/// Without the sources whose share of all power sent is no more than the tolerance: were their
/// light wrong everywhere, it would still be within it.
std::vector<LightSource> strong_enough(std::vector<LightSource> sources, const SoundScene& scene,
                                       double tolerance);

/// Why direct light, and the curves where it breaks, deserve no effort; empty if they do.
std::string most_surfaces_emit(const SoundScene& scene);

}  // namespace halfshade
