#include "solver/reflected/allowed_error.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Of the square of the tolerance, for G, whatever else is off.
constexpr double least_left = 0.04;

}  // namespace

double norm_square(const ReflectedOptions& options, const Rgb& scale, double square_total) {
  return options.weight ? std::pow(scale.minCoeff() * options.norm, 2) : square_total;
}

double allowed_square(const ReflectedOptions& options, const Rgb& scale, double all) {
  const double whole = std::pow(options.tolerance, 2) * all;
  const double others = std::pow(scale.minCoeff() * options.other_error, 2);
  return std::max(whole - others, least_left * whole);
}

}  // namespace halfshade
