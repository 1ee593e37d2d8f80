#pragma once

#include "solver/pipeline/band_light.h"

#include <vector>

namespace halfshade {

/// Throws Error(invalid_input) where nothing fixes temperatures that are to be found: where
/// adiabatic surfaces are closed in with others of them, and with what absorbs nothing, in all
/// bands in which they absorb. Faces of one temperature pass heat on from band to band, and from
/// side to side. `materials` has a row for each of the result's, which were made of `original` of
/// `scene`; empty: they are the same. Cost: that of find_cells for the fewest elements.
void require_fixed_temperatures(const Scene& scene, const Heat& heat,
                                const BandMaterials& materials, const std::vector<int>& original,
                                const SoundScene& sound);

/// Throws Error(invalid_input): the bands hold too little to tell the temperature of an adiabatic
/// face.
[[noreturn]] void refuse_bands(const Scene& scene, int face);

/// Bands in which something that is not at 0 K sends out less than can be followed, as 1.
Eigen::ArrayXd unseen_bands(const Heat& heat);

}  // namespace halfshade
