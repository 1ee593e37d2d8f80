#pragma once

#include "meshing/core/sound_scene.h"

#include <vector>

namespace halfshade {

/// The surfaces whose sides look into a part of space.
struct PartSides {
  std::vector<int> fronts, backs;
};

/// The first surface of `backs` whose back can get light that emitters of `fronts` send and the
/// others reflect, as far as it tells from which of them lie before which; −1 if there is none.
/// What comes between two surfaces does not count. Cost: n² for n surfaces, but no more than some
/// seconds: where that does not do, the first.
int first_lit_back(const SoundScene& scene, const PartSides& sides);

}  // namespace halfshade
