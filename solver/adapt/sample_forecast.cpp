#include "solver/adapt/sample_forecast.h"

#include <cmath>
#include <utility>

namespace halfshade {

std::optional<double> SampleForecast::in_the_end(double samples, double square_error) {
  const double samples_before = std::exchange(samples_, samples),
               error_before = std::exchange(square_error_, square_error);
  if (!(samples_before > 0 && samples > samples_before && square_error < error_before))
    return std::nullopt;
  const double order = std::log(error_before / square_error) / std::log(samples / samples_before);
  return samples * std::pow(square_error, 1 / order);
}

}  // namespace halfshade
