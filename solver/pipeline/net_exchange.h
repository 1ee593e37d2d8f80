#pragma once

#include "solver/pipeline/band_light.h"

namespace halfshade {

/// Solves a scene with what is said of its heat. Space that radiates b = σT⁴ from everywhere is
/// taken into account by what differs from it: with B′ = B − b, H′ = H − b and E′ = E − (1 − ρ) b
/// the equation of radiosity is the same, and space is dark. Where E′ has both signs, the two parts
/// are channels of their own, so that nothing emits less than nothing, and their difference is the
/// solution: exactly, for the equation is linear. Bands and their parts go through `solve` three at
/// a time, on elements that all of them share. With more than three bands the channels of the
/// result are their sum, and the solution has each band beside. Adiabatic faces in several bands
/// or on two sides have the temperatures at which they absorb what they send out, see
/// find_temperatures.
///
/// With surroundings, `direct_irradiance` is what comes straight from E′, not from E, and power
/// that escapes is what space gets net. Throws as `solve`, solve_bands, find_temperatures and
/// require_fixed_temperatures do, and Error(invalid_input) where it is not known what the
/// surroundings send in each channel, or a band holds too little to tell an adiabatic temperature.
SolveResult solve_net_exchange(const Scene& scene, const Heat& heat, const SceneSolver& solve);

}  // namespace halfshade
