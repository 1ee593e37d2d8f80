#pragma once

#include "meshing/core/scene.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

/// Heat that surfaces exchange by radiation.
namespace halfshade {

/// σ in W/(m² K⁴), CODATA 2018: exact in the units of 2019 but for its last digit.
inline constexpr double stefan_boltzmann = 5.670374419e-8;

/// A part of the spectrum that is solved by itself: a channel with a name.
struct Band {
  std::string name;
  /// Wavelengths in µm; 0 and infinite by default. Without them it is not known which part of what
  /// a hot surface emits lies in the band.
  bool has_wavelengths = false;
  double shortest = 0, longest = HUGE_VAL;

  bool operator==(const Band&) const = default;
};

/// At most as many bands as there are channels.
inline constexpr std::size_t most_bands = 3;

/// What is said of a material beside its reflectance and exitance, which follow from it.
struct HeatMaterial {
  std::optional<double> temperature;  ///< K, ≥ 0; the exitance is ε σ T⁴, ε = 1 − rho
  bool is_adiabatic = false;          ///< gives net nothing: rho = 1, exitance 0, T is found
};

/// What a scene says of heat.
struct Heat {
  bool is_given = false;    ///< anything but reflectances and exitances
  std::vector<Band> bands;  ///< channels in order; none: three colours, or one grey band
  std::vector<HeatMaterial> materials;  ///< one a material of the scene; none if nothing is given
  std::optional<double> surroundings;   ///< K, of what space radiates; none: it is dark
};

/// Share of σT⁴ at wavelengths shorter than this: the series of Chang and Rhee (1984), to rounding.
/// `wavelength` in µm ≥ 0 or infinite, `temperature` in K ≥ 0.
double blackbody_share_below(double wavelength, double temperature);

/// What a black body sends out in each channel, W/m²: σT⁴ in all without bands or with one that has
/// no wavelengths, else what lies in each band; 0 in channels without a band. Precondition: several
/// bands have wavelengths.
Rgb blackbody_exitance(double temperature, const std::vector<Band>& bands);

/// The temperature of a black body that sends out this much, K; `exitance` in W/m², ≥ 0.
double blackbody_temperature(double exitance);

/// Metres in a unit of length by its name or sign ("mm", "inch", …); nothing if it is not known.
std::optional<double> metres_in(const std::string& unit);

}  // namespace halfshade
