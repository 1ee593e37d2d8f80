#pragma once

#include "meshing/core/types.h"

#include <array>
#include <cstdint>
#include <span>

namespace halfshade {

/// The factor from W/m² to display values that makes the 95th percentile of `values` (their
/// brightest channel, by `weights`) come out at 0.8 of linear white. Where most of the weight lies
/// in the dark, the percentile says little and a quarter of the mean brightness that the light
/// itself sees, Σ w v² / Σ w v, takes its place. Values whose entry in `emits` is not 0 are left
/// out, for lamps are meant to saturate, unless no other value is positive. Scales inversely with
/// the values; 1 if all are zero. Values that are not finite are ignored. Spans must be equally
/// long, weights ≥ 0.
double choose_exposure(std::span<const Rgb> values, std::span<const double> weights,
                       std::span<const std::uint8_t> emits);

/// Linear display values in [0,1] of a radiosity: proportional up to 0.6 in the brightest channel,
/// from there on a shoulder towards 1 that keeps the ratios of the channels, and for values far
/// above white a turn towards white. Never NaN, whatever comes in.
Rgb tone_map(const Rgb& radiosity, double exposure);

/// The sRGB encoding (IEC 61966-2-1) of linear values in [0,1], rounded to 8 bits.
std::array<std::uint8_t, 3> encode_srgb(const Rgb& linear);

}  // namespace halfshade
