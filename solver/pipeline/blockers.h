#pragma once

#include "meshing/core/sound_scene.h"

#include <span>
#include <vector>

namespace halfshade {

/// The surfaces that can come between others: those that have some before them and some behind.
/// Backs of two-sided ones are left out.
std::vector<int> blocking_surfaces(const SoundScene& scene);

/// Those of `ids` that some of them or of `others` lie before and behind.
std::vector<int> blocking_surfaces(const SoundScene& scene, std::span<const int> ids,
                                   std::span<const int> others);

/// True if no straight line that passes three edges of these surfaces leaves all of them unpierced
/// but for those in a face's plane: they are the whole boundary of a convex body, one convex
/// polygon, or none.
bool is_one_convex_body(const SoundScene& scene, const std::vector<int>& surfaces);

}  // namespace halfshade
