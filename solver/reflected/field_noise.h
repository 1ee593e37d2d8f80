#pragma once

#include "solver/reflected/reflected_mesh.h"

#include <array>
#include <vector>

namespace halfshade {

/// Element → ∫ over it of the square of what rays are off, in the polynomials of each degree.
using FieldNoise = std::vector<std::array<double, max_reflected_order + 1>>;

/// Noise of stratified rays falls faster than their number rises.
inline constexpr double noise_exponent = 1.3;

/// The number of rays sent at once that leave as much noise as the best mean of two independent
/// results, by `a` and by `b` rays: fewer than a + b.
double rays_as_good_as(double a, double b);

/// How many have to go with `sent` to be as good as `wanted` at once; 0 if those are as good.
double rays_missing(double wanted, double sent);

/// Means of two rows that belong together: 2 k and 2 k + 1.
ChannelArray means_of_halves(const ChannelArray& halves);

/// Of the mean of two halves of rays from each node: rows 2 node and 2 node + 1.
FieldNoise::value_type noise_of_halves(const ElementNodes& nodes, double area,
                                       const ChannelArray& halves);

/// Of the mean of two independent results, in which the second has a share.
FieldNoise::value_type mean_noise(const FieldNoise::value_type& a, const FieldNoise::value_type& b,
                                  double share_of_b);

/// Over all degrees, times `weight`; one number an element.
std::vector<double> noise_of_elements(const FieldNoise& noise, const std::vector<double>& weight);

}  // namespace halfshade
