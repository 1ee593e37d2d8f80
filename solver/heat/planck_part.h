#pragma once

namespace halfshade {

/// A part of what a black body sends out, in shares of σT⁴.
struct PlanckPart {
  double share = 0;
  double slope = 0;  ///< T/σT⁴ times the derivative of its power by the temperature
};

/// What lies between two wavelengths, in µm, 0 ≤ shortest ≤ longest, maybe infinite; `temperature`
/// in K ≥ 0. By the series of Chang and Rhee (1984), or of powers for long waves; bands so narrow
/// that these would leave a small difference are integrated. To rounding of itself, not of σT⁴.
PlanckPart planck_part(double shortest, double longest, double temperature);

}  // namespace halfshade
