#include "solver/elements/error_weight.h"

#include "solver/elements/element_field.h"

namespace halfshade {

double mean_weight(const ErrorWeight& weight, int surface, const std::array<Vec3, 3>& triangle) {
  if (!weight) return 1;
  constexpr int degree = 4;  // six places, all inside
  double sum = 0;
  for (const TriangleNode& node : triangle_rule(degree))
    sum += node.weight * weight(surface, position(triangle, {node.u, node.v}));
  return sum;
}

}  // namespace halfshade
