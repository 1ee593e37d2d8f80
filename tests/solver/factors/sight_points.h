#pragma once

#include "solver/factors/few_blockers.h"
#include "solver/factors/sight_scene.h"
#include "tests/support/random.h"

#include <utility>
#include <vector>

namespace halfshade::test {

/// Anywhere in a surface of three or four corners.
inline Vec3 point_of(const SightSurface& surface, Random& random) {
  const Polygon3& corners = surface.outline;
  const double s = random(0, 1), t = random(0, 1);
  const Vec3 bottom = corners[0] + s * (corners[1] - corners[0]);
  const Vec3 top = corners[3 % corners.size()] + s * (corners[2] - corners[3 % corners.size()]);
  return bottom + t * (top - bottom);
}

/// All that surface `a` may see past few things, from the same points. `shadows` and `memory` must
/// outlive them.
inline std::vector<std::pair<int, ShadedTarget>> targets_of(const SightScene& sight, int a,
                                                            SharedShadows& shadows,
                                                            TargetMemory& memory) {
  std::vector<std::pair<int, ShadedTarget>> targets;
  for (int b = 0; b < static_cast<int>(sight.surfaces.size()); ++b) {
    if (!may_see(sight, a, b)) continue;
    const FewBlockers blockers(sight, a, b);
    if (blockers.is_applicable()) targets.emplace_back(b, blockers.shaded_target(shadows, memory));
  }
  return targets;
}

}  // namespace halfshade::test
