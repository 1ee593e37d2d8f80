#include "solver/adapt/field_beginnings.h"

#include "meshing/core/error.h"
#include "meshing/core/rounded.h"
#include "solver/elements/triangle_key.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {

void require_usable(const AdaptiveFieldOptions& options) {
  if (!(options.tolerance > 0 && std::isfinite(options.tolerance)) || options.order < -1 ||
      options.order > max_order || options.highest_order < 2 || options.highest_order > max_order ||
      !(options.norm >= 0) || options.max_elements < 1 || options.max_unknowns < 1)
    throw Error(
        ErrorCode::contract, "fit_adaptively",
        fmt::format("tolerance ({}), norm ({}), order ({}), highest_order ({}), max_elements ({}) "
                    "or max_unknowns ({}) is out of range",
                    options.tolerance, options.norm, options.order, options.highest_order,
                    options.max_elements, options.max_unknowns));
}

int first_order(const AdaptiveFieldOptions& options) {
  if (options.order >= 0) return options.order;
  return std::clamp(static_cast<int>(std::lround(-0.75 * std::log10(options.tolerance))), 2,
                    std::min(options.highest_order, 5));
}

CountedElements counted_elements(const ElementTable& elements,
                                 const AdaptiveFieldOptions& options) {
  CountedElements result, all;
  for (std::size_t e = 0; e < elements.area.size(); ++e) {
    const CountedElements one{1, elements.area[e]};
    all += one;
    if (counts(options, elements.surface[e])) result += one;
  }
  return result.count > 0 ? result : all;
}

int beginning_order(const AdaptiveFieldOptions& options, const CountedElements& all, int surface,
                    double area) {
  if (options.order >= 0) return options.order;
  if (!counts(options, surface)) return 0;
  constexpr double small = 0.25, tiny = 0.025;
  const double share = rounded(area * all.count / all.area);
  return std::max(first_order(options) - (share < tiny ? 2 : share < small ? 1 : 0), 0);
}

TrianglePlace spread_place(std::size_t index) {
  constexpr double root = 1.32471795724474602596;  // of x³ = x + 1
  double s = std::fmod(0.5 + static_cast<double>(index + 1) / root, 1.);
  double t = std::fmod(0.5 + static_cast<double>(index + 1) / (root * root), 1.);
  if (s + t > 1) s = 1 - s, t = 1 - t;
  return {s, t};
}

std::size_t first_spread(const std::array<Vec3, 3>& triangle) {
  constexpr int dropped = 44;  // more than a million would take digits of the places
  return triangle_key(triangle) >> dropped;
}

}  // namespace halfshade
