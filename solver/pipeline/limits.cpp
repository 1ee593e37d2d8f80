#include "solver/pipeline/limits.h"

#include <algorithm>

namespace halfshade {
namespace {

constexpr std::size_t fewest_elements = 40000, elements_each = 40, most_elements = 1000000;
constexpr int fewest_unknowns = 1000000, unknowns_each = 4;

}  // namespace

SolveOptions with_limits(SolveOptions options, std::size_t polygons) {
  if (options.max_elements == 0)
    options.max_elements = static_cast<int>(
        options.method == SolveMethod::matrix
            ? fewest_elements
            : std::clamp(elements_each * polygons, fewest_elements, most_elements));
  if (options.max_unknowns == 0)
    options.max_unknowns = std::max(fewest_unknowns, unknowns_each * options.max_elements);
  return options;
}

}  // namespace halfshade
