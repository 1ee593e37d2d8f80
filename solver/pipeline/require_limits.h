#pragma once

#include "solver/elements/material_arrays.h"
#include "solver/exchange/exchange.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve_options.h"

#include <span>
#include <string>
#include <vector>

namespace halfshade {

/// Refuses a closed enclosure that reflects all its light with Error(invalid_input), which names
/// its groups; `group` has one of `group_names` for each row of the exchange.
void require_limits(const std::vector<std::string>& group_names, std::span<const int> group,
                    const Exchange& exchange, const MaterialArrays& materials,
                    const RadiosityOptions& options);

/// The same before anything is computed. Painted surfaces are not judged: what they absorb is known
/// from their pictures, and to those who solve for reflected light. Cost: none where no surface
/// reflects everything, else that of a mesh without a length.
void require_limits(const PreparedScene& prepared, const RadiosityOptions& options,
                    const Progress& progress = {});

}  // namespace halfshade
