#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "meshing/rays/visibility.h"
#include "solver/exchange/cells.h"
#include "solver/reflected/triangle_forest.h"

#include <cstdint>
#include <vector>

namespace halfshade {

/// A scene as few triangles, with what rays need to know of it: the roots of forests.
struct ReflectingScene {
  ElementTable roots;
  SpaceCells cells;
  /// Root → another surface of its plane looks the other way, and may lie back to back with it.
  std::vector<bool> two_sided;
  VisibilityIndex visibility;  ///< of the roots; owner = root
};

/// Cost: that of a mesh without a length, and n log n for n roots.
ReflectingScene make_reflecting_scene(const SoundScene& scene, const Progress& progress = {});

/// A number in [0, 1) for each seed and place in its sequence.
double random_number(std::uint64_t seed, std::uint64_t place);

}  // namespace halfshade
