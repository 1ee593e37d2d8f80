#pragma once

#include "meshing/core/sound_scene.h"

#include <span>
#include <vector>

namespace halfshade {

/// The surfaces, in order, that are near and large enough to get a noticeable part of emitters'
/// light, by size and distance: those that could have more than `share` of the L2 norm of the light
/// that all could have, and emitters but suns; all of them if nothing emits. What the others do is
/// worth no effort.
std::vector<int> lit_surfaces(const SoundScene& scene, double share);

/// Surface → whether it is one of `ids`.
std::vector<bool> mark_surfaces(const SoundScene& scene, std::span<const int> ids);

/// Of the tolerance: what surfaces may get at most that are not to change what is done elsewhere.
inline constexpr double unnoticed_of_tolerance = 0.01;
/// Of all light: the same where there is no tolerance.
inline constexpr double hardly_lit = 1e-4;

}  // namespace halfshade
