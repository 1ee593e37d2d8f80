#pragma once

#include "meshing/core/types.h"

namespace halfshade {

/// What is not known of the light that an element loses.
struct UnsureLoss {
  Rgb factor = Rgb::Zero();  ///< its form factors to all others may be off by this in the mean
  double parts = 0;          ///< into which its length had to be cut to know; 0: unknown
  double within = 1;         ///< by how much errors over a part of it grow as they are reflected on
};

}  // namespace halfshade
