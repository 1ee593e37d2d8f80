#pragma once

#include "solver/factors/factor_scene.h"

#include <vector>

namespace halfshade {

/// Where the surface of a row lies. Names and areas alone do not tell a scene from one in which
/// something was moved or turned.
struct RowPlace {
  Vec3 centre = Vec3::Zero();  ///< of its area, scene units
  Vec3 normal = Vec3::Zero();  ///< of all its parts together, of length 1
  Vec3 extent = Vec3::Zero();  ///< edges of the box round it, scene units
};

/// One a row of a scene by face.
std::vector<RowPlace> row_places(const FactorScene& faces);

}  // namespace halfshade
