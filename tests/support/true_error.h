#pragma once

#include "solver/elements/element_field.h"
#include "solver/elements/quadrature.h"

#include <cmath>
#include <functional>

namespace halfshade::test {

/// Mean over the standard triangle of a function of the place, by the rule of degree 22 on each of
/// parts² equal parts.
inline double triangle_mean(int parts, const std::function<double(const TrianglePlace&)>& f) {
  const TriangleRule& rule = gauss_rule(22);
  double sum = 0;
  for (int j = 0; j < parts; ++j)
    for (int i = 0; i + j < parts; ++i)
      for (const int turned : {0, 1}) {
        if (turned == 1 && i + j + 1 >= parts) continue;
        const TrianglePlace corner(i + turned, j + turned);
        for (std::size_t k = 0; k < rule.places.size(); ++k)
          sum += rule.weights[static_cast<Eigen::Index>(k)] *
                 f((corner + (turned == 1 ? -1 : 1) * rule.places[k]) / parts);
      }
  return sum / (parts * parts);
}

/// ‖f − field‖ over all elements in the L2 norm, relative to ‖f‖, channels' squares summed; `f` is
/// of a position.
inline double true_relative_error(const ElementTable& elements, const ElementField& field,
                                  const std::function<Rgb(const Vec3&)>& f, int parts) {
  double error = 0, norm = 0;
  for (int e = 0; e < elements.count(); ++e) {
    const auto triangle = elements.triangle(e);
    error += elements.area[at(e)] * triangle_mean(parts, [&](const TrianglePlace& place) {
               const Rgb off = f(position(triangle, place)) - value_at(field, e, place);
               return off.matrix().squaredNorm();
             });
    norm += elements.area[at(e)] * triangle_mean(parts, [&](const TrianglePlace& place) {
              return f(position(triangle, place)).matrix().squaredNorm();
            });
  }
  return std::sqrt(error / norm);
}

}  // namespace halfshade::test
