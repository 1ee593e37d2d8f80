#pragma once

#include "meshing/core/sound_scene.h"

#include <vector>

namespace halfshade {

/// The surfaces that can come between others: those that have some before them and some behind.
/// Backs of two-sided ones are left out.
std::vector<int> blocking_surfaces(const SoundScene& scene);

/// The same among surfaces near enough to emitters to get a noticeable part of their light, by size
/// and distance alone: what far and tiny things have before or behind them is worth no effort.
std::vector<int> blocking_in_the_light(const SoundScene& scene);

/// True if no straight line that passes three edges of these surfaces leaves all of them unpierced
/// but for those in a face's plane: they are the whole boundary of a convex body, one convex
/// polygon, or none.
bool is_one_convex_body(const SoundScene& scene, const std::vector<int>& surfaces);

}  // namespace halfshade
