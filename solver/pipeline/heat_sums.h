#pragma once

#include "solver/heat/heat.h"
#include "solver/pipeline/solve.h"

#include <string>
#include <vector>

namespace halfshade {

/// How many channels of a result mean something: 1 if all are alike, else bands or colours.
int channels_of(const SolveResult& result);

/// Of adiabatic surfaces in one band with this irradiance, W/m²; K.
double temperature_in_balance(double irradiance, const Heat& heat);

/// Temperatures in K of elements of the result, or parts of them, with this irradiance (W/m²): as
/// given, or found where the net flux is; NaN where there is none.
Eigen::ArrayXd temperatures(const SolveResult& result, const ElementTable& elements,
                            const ChannelArray& irradiance);

/// Heat of a group of faces.
struct GroupHeat {
  std::string name;
  double area = 0;           ///< m²
  Eigen::ArrayXd net_power;  ///< what it gives net in each channel: ∫ B − H, W
  double temperature = NAN;  ///< K; NaN unless all of it has the same, or is adiabatic
};

/// Net exchange of a result in SI units.
struct HeatSums {
  double metres = 1;  ///< in the unit of length
  std::vector<GroupHeat> groups;
  Eigen::ArrayXd to_space;  ///< net power that leaves through openings in each channel, W
};

/// Metres in a unit of length; throws Error(invalid_input) if it is not known.
double require_metres_in(const std::string& unit);

/// Throws as require_metres_in.
HeatSums sum_heat(const SolveResult& result);

}  // namespace halfshade
