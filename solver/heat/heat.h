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

/// W/m²: weaker parts of what black bodies send out count as nothing. What light of less than
/// 1e-200 W/m² becomes on its way, doubles cannot hold.
inline constexpr double weakest_part = 1e-190;

/// A part of the spectrum that is solved by itself: a channel with a name.
struct Band {
  std::string name;
  /// Wavelengths in µm; 0 and infinite by default. Without them it is not known which part of what
  /// a hot surface emits lies in the band.
  bool has_wavelengths = false;
  double shortest = 0, longest = HUGE_VAL;

  bool operator==(const Band&) const = default;
};

/// As many bands a scene's channels can hold; more stand beside it.
inline constexpr int most_channels = 3;

/// What is said of a material beside its reflectance and exitance, which follow from it.
struct HeatMaterial {
  std::optional<double> temperature;  ///< K, ≥ 0; the exitance is ε σ T⁴, ε = 1 − rho
  /// Gives net nothing and has exitance 0: T is found. In one band rho = 1 says the same of faces
  /// with one side.
  bool is_adiabatic = false;
  Eigen::ArrayXd rho = {}, exitance = {};  ///< one a band (W/m²); empty if no bands are named
};

/// What a scene says of heat.
struct Heat {
  bool is_given = false;                ///< anything but reflectances and exitances
  std::vector<Band> bands;              ///< in order; none: three colours, or one grey band
  std::vector<HeatMaterial> materials;  ///< one a material of the scene; none if nothing is given
  std::optional<double> surroundings;   ///< K, of what space radiates; none: it is dark
};

/// Share of σT⁴ at wavelengths shorter than this, to rounding, see planck_part.
/// `wavelength` in µm ≥ 0 or infinite, `temperature` in K ≥ 0.
double blackbody_share_below(double wavelength, double temperature);

/// What a black body sends out in each band, W/m²: σT⁴ without bands or with one that has no
/// wavelengths, else what lies in each, from weakest_part on. Precondition: several bands have
/// wavelengths.
Eigen::ArrayXd blackbody_exitance(double temperature, const std::vector<Band>& bands);

/// Its derivative by the temperature, W/(m² K). Preconditions: as above; the temperature is > 0.
Eigen::ArrayXd blackbody_slope(double temperature, const std::vector<Band>& bands);

/// Values of bands as channels of a scene: one is all channels, up to three are the first ones,
/// and for more `all` stands in each.
Rgb to_channels(const Eigen::ArrayXd& by_band, double all);

/// How many there are; 1 if none is named.
int bands_of(const Heat& heat);

/// Whether faces of a material have a temperature each that is found from the balance of several
/// bands or of two sides together. Other adiabatic faces reflect all, and theirs follows.
bool is_balanced(const Heat& heat, const std::vector<Material>& materials, int material);

/// Whether any material's are. `materials` are the scene's.
bool balances_faces(const Heat& heat, const std::vector<Material>& materials);

/// Throws Error(invalid_input) unless some face sends out heat, or the surroundings do.
void require_heat(const Scene& scene, const Heat& heat);

/// The temperature of a black body that sends out this much, K; `exitance` in W/m², ≥ 0.
double blackbody_temperature(double exitance);

/// Metres in a unit of length by its name or sign ("mm", "inch", …); nothing if it is not known.
std::optional<double> metres_in(const std::string& unit);

}  // namespace halfshade
