#pragma once

#include "solver/direct/direct_light.h"
#include "solver/pipeline/solve.h"

#include <span>
#include <vector>

namespace halfshade {

/// What a solution says of a point of a surface.
struct PointLight {
  Rgb irradiance = Rgb::Zero();         ///< W/m²
  Rgb direct_irradiance = Rgb::Zero();  ///< the part that comes straight from emitters
};

/// The values of a result's elements at points on its surfaces, nothing computed anew: polynomials
/// where there are some, else the means of the elements. Of several surfaces in one plane a point
/// belongs to the one whose polygon it lies in. Throws Error(invalid_input) for a point that lies
/// on no surface with its normal, see SurfaceFinder.
std::vector<PointLight> light_at_points(const SolveResult& result,
                                        std::span<const SurfacePoint> points);

/// Irradiance at points, on surfaces or not, from exact direct light and what a solution's elements
/// reflect: by exactly visible parts where the solution is made of them, else by as many rays as
/// its tolerance is worth. Two or three times as exact as the elements' polynomials. Surfaces as
/// on_surfaces() finds them. Adds to `light`, which holds the direct light of the first points.
/// Precondition: the result has reflected light, or nothing reflects. On all threads; returns false
/// if stopped.
bool add_gathered_light(const SolveResult& result, double tolerance,
                        std::span<const FieldPoint> points, std::span<DirectLight> light,
                        const Progress& progress = {});

/// The same with nothing but reflected light given.
bool add_gathered_light(const ReflectedLight& reflected, double tolerance,
                        std::span<const FieldPoint> points, std::span<DirectLight> light,
                        const Progress& progress = {});

}  // namespace halfshade
