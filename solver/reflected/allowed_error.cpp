#include "solver/reflected/allowed_error.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// For G, whatever else is off: of the square of the tolerance, or of what else is off if that is
/// more, for then it would hardly show if G were any better.
constexpr double least_left = 0.04;

}  // namespace

double norm_square(const ReflectedOptions& options, const Rgb& scale, double square_total) {
  return options.weight ? std::pow(scale.minCoeff() * options.norm, 2) : square_total;
}

double allowed_square(const ReflectedOptions& options, const Rgb& scale, double all) {
  const double whole = std::pow(options.tolerance, 2) * all;
  const double others = std::pow(scale.minCoeff() * options.other_error, 2);
  return std::max(whole - others, least_left * std::max(whole, others));
}

}  // namespace halfshade
