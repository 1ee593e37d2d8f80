#include "solver/pipeline/limits.h"

#include <algorithm>

namespace halfshade {
namespace {

constexpr std::size_t lowest_limit = 40000, limit_each = 400, highest_limit = 1000000;
/// Very many polygons take more, about so many each, up to what memory holds.
constexpr std::size_t least_each = 16, most_of_all = 10000000;
constexpr int lowest_of_unknowns = 1000000, unknowns_each = 4;

}  // namespace

SolveOptions with_limits(SolveOptions options, std::size_t polygons) {
  if (options.max_elements == 0)
    options.max_elements = static_cast<int>(
        options.method == SolveMethod::matrix
            ? lowest_limit
            : std::clamp(limit_each * polygons, lowest_limit,
                         std::clamp(least_each * polygons, highest_limit, most_of_all)));
  if (options.max_unknowns == 0)
    options.max_unknowns = std::max(lowest_of_unknowns, unknowns_each * options.max_elements);
  return options;
}

}  // namespace halfshade
