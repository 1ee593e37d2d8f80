#pragma once

#include "meshing/core/sound_scene.h"
#include "solver/elements/element_field.h"
#include "solver/elements/error_weight.h"
#include "solver/reflected/reflected_light.h"

#include <string_view>

namespace halfshade {

/// One number asked for: the mean irradiance of a group.
struct GoalResult {
  int group = 0;
  double area = 0;            ///< of it, squared scene units
  Rgb mean = Rgb::Zero();     ///< W/m²
  double relative_error = 0;  ///< of the mean, all channels together: an estimate
  std::size_t unknowns = 0;   ///< coefficients per channel, of direct and reflected light
};

/// What an error of light at any place does to a goal, by the adjoint of the light: z = ψ + ρ K z,
/// ψ = 1/area on the group. K is its own adjoint, so z is found like light that the group emits. An
/// error r, of direct light or left in the equation of reflected light, moves the goal by ∫ z r,
/// which is at most √(∫ z ∫ z r²) (Becker and Rannacher 2001, for finite elements). No weight where
/// no light reaches the group.
struct GoalWeights {
  int group = 0;
  ErrorWeight weight;  ///< z ∫ z, z that of the channel where it is largest, squared scene units⁻¹
  double norm = 0;  ///< W/m²: a little less than the mean, its channels' squares summed
};

/// The area of a group's surfaces, squared scene units.
double area_of_group(const SoundScene& scene, int group);

/// The id of a group. Throws Error(usage), with all names, if there is none of that name.
int find_goal(const SoundScene& scene, std::string_view name);

/// The mean over a group of direct light on elements plus reflected light, if there is any.
/// `relative_error` is left 0.
GoalResult goal_mean(int group, const ElementTable& elements, const ElementField& direct,
                     const ReflectedLight* reflected);

}  // namespace halfshade
