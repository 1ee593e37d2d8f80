#include "solver/pipeline/element_limit.h"

#include <algorithm>

namespace halfshade {
namespace {

constexpr std::size_t least_limit = 40000, limit_each = 40, highest_limit = 1000000;

}  // namespace

SolveOptions with_element_limit(SolveOptions options, std::size_t polygons) {
  if (options.max_elements != 0) return options;
  const std::size_t limit = options.method == SolveMethod::matrix
                                ? least_limit
                                : std::clamp(limit_each * polygons, least_limit, highest_limit);
  options.max_elements = static_cast<int>(limit);
  return options;
}

}  // namespace halfshade
