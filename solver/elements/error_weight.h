#pragma once

#include "meshing/core/types.h"
#include "solver/elements/quadrature.h"

#include <array>
#include <functional>

namespace halfshade {

/// How much the square of an error counts at a point of a surface, ≥ 0. None: 1 everywhere.
using ErrorWeight = std::function<double(int surface, const Vec3& position)>;

/// Its mean over a triangle, from six places.
double mean_weight(const ErrorWeight& weight, int surface, const std::array<Vec3, 3>& triangle);

}  // namespace halfshade
