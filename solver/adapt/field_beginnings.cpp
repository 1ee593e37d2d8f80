#include "solver/adapt/field_beginnings.h"

#include "meshing/core/error.h"
#include "meshing/core/rounded.h"
#include "solver/adapt/element_fit.h"
#include "solver/elements/triangle_key.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

double samples_left(const AdaptiveFieldOptions& options) {
  return options.samples_left ? options.samples_left() : std::numeric_limits<double>::infinity();
}

std::vector<int> beginning_orders(const ElementTable& elements, const CountedElements& all,
                                  const AdaptiveFieldOptions& options) {
  if (options.order >= 0) return std::vector<int>(elements.corners.size(), options.order);
  constexpr double small = 0.25, tiny = 0.025, share_of_first_round = 0.5;
  std::vector<int> result;
  for (std::size_t e = 0; e < elements.corners.size(); ++e) {
    const double share = rounded(elements.area[e] * all.count / all.area);
    const int lower = share < tiny ? 2 : share < small ? 1 : 0;
    result.push_back(
        counts(options, elements.surface[e]) ? std::max(first_order(options) - lower, 0) : 0);
  }
  const double most = share_of_first_round * samples_left(options);
  for (int lower = 0; lower < first_order(options); ++lower) {
    double samples = 0;
    for (const int order : result) samples += sampling_rule(order).count();
    if (samples <= most) break;
    for (int& order : result) order = std::max(order - 1, 0);
  }
  return result;
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
