#pragma once

#include "meshing/core/types.h"

namespace halfshade {

struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
};

}  // namespace halfshade
