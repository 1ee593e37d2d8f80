#pragma once

#include "meshing/patches/element_table.h"
#include "solver/elements/solution.h"
#include "solver/pipeline/prepared_scene.h"

namespace halfshade {

/// How far constant elements are from direct light, in the mean that recovery_estimate takes: from
/// exact values at places spread over each, so that it knows of shadows narrower than an element.
/// Places go half by area, half by the square of direct light, at least one to an element. In
/// W/m²; zero if stopped. Cost: a look at all emitters from each of some 6000 places, and from
/// one of each element.
Eigen::ArrayXd measured_error(const PreparedScene& prepared, const ElementTable& elements,
                              const ChannelArray& direct_irradiance, const Progress& progress);

}  // namespace halfshade
