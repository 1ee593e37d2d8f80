#pragma once

#include "meshing/core/scene.h"

namespace halfshade {

/// Every length below which two things count as one, derived from the scene's size in one place.
/// Topological decisions (which side, do they cross) are made by exact predicates, not by these.
struct Tolerance {
  double scene_size = 1;  ///< diagonal of the bounding box of all faces
  double length = 0;      ///< points closer than this are the same point
  double planarity = 0;   ///< a polygon deviating less than this from its plane is planar
};

/// Precondition: `scene` is valid.
Tolerance make_tolerance(const Scene& scene);

}  // namespace halfshade
