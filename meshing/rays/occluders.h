#pragma once

#include "meshing/core/sound_scene.h"

#include <array>
#include <vector>

namespace halfshade {

/// Opaque triangles, each with an owner (a surface or an element, as the maker of the soup
/// chooses) and the id of the plane it lies in.
struct TriangleSoup {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> owner;
  std::vector<int> plane;
};

/// The surfaces as coarse triangles; owner = surface. Backs of two-sided faces are left out, for
/// their fronts already block.
TriangleSoup occluders(const SoundScene& scene);

/// The same with backs, for rays that ask which side they meet.
TriangleSoup surface_triangles(const SoundScene& scene);

}  // namespace halfshade
