#pragma once

#include "solver/direct/direct_light.h"
#include "solver/pipeline/solve.h"

#include <span>
#include <vector>

namespace halfshade {

/// What a solution says of a point of a surface.
struct SolvedLight {
  Rgb irradiance = Rgb::Zero();         ///< W/m²
  Rgb direct_irradiance = Rgb::Zero();  ///< the part that comes straight from emitters
};

/// The values of a result's elements at points on its surfaces, nothing computed anew: polynomials
/// where there are some, else the means of the elements. Of several surfaces in one plane a point
/// belongs to the one whose polygon it lies in. Throws Error(invalid_input) for a point that lies
/// on no surface with its normal, up to a millionth of the surface's size.
std::vector<SolvedLight> light_at_points(const SolveResult& result,
                                         std::span<const SurfacePoint> points);

}  // namespace halfshade
