#pragma once

#include "solver/heat/heat.h"
#include "solver/pipeline/solve.h"

#include <functional>
#include <string>
#include <vector>

namespace halfshade {

/// Solves a scene with what is said of its heat. Space that radiates b = σT⁴ from everywhere is
/// taken into account by what differs from it: with B′ = B − b, H′ = H − b and E′ = E − (1 − ρ) b
/// the equation of radiosity is the same, and space is dark. Where E′ has both signs, the two parts
/// are channels of their own, so that nothing emits less than nothing, and their difference is the
/// solution: exactly, for the equation is linear. `solve` is any way to solve a scene; it is called
/// once. With surroundings, `direct_irradiance` is what comes straight from E′, not from E, and
/// power that escapes is what space gets net. Throws as `solve` does, and Error(invalid_input)
/// where bands of both signs take more than three channels.
SolveResult solve_net_exchange(const Scene& scene, const Heat& heat,
                               const std::function<SolveResult(const Scene&)>& solve);

/// How many channels of a result mean something: 1 if all are alike, else bands or colours.
int channels_of(const SolveResult& result);

/// Temperatures in K of elements of these materials with this irradiance (W/m²): as given, or found
/// where the net flux is; NaN where there is none.
Eigen::ArrayXd temperatures(const Heat& heat, const std::vector<int>& material,
                            const ChannelArray& irradiance);

/// Heat of a group of faces.
struct GroupHeat {
  std::string name;
  double area = 0;              ///< m²
  Rgb net_power = Rgb::Zero();  ///< what it gives net: ∫ B − H, W
  double temperature = NAN;     ///< K; NaN unless all of it has the same, or is adiabatic
};

/// Net exchange of a result in SI units.
struct HeatSums {
  double metres = 1;  ///< in the unit of length
  std::vector<GroupHeat> groups;
  Rgb to_space = Rgb::Zero();  ///< net power that leaves through openings, W
};

/// Metres in a unit of length; throws Error(invalid_input) if it is not known.
double require_metres_in(const std::string& unit);

/// Throws as require_metres_in.
HeatSums sum_heat(const SolveResult& result);

}  // namespace halfshade
