#include "solver/adapt/sample_forecast.h"

#include <cmath>
#include <utility>

namespace halfshade {
namespace {

constexpr double least_share = 0.1;
constexpr int least_calls = 2;

}  // namespace

std::optional<double> SampleForecast::in_the_end(double samples, double square_error) {
  const double samples_before = std::exchange(samples_, samples),
               error_before = std::exchange(square_error_, square_error);
  if (!(samples_before > 0 && samples > samples_before && square_error < error_before))
    return std::nullopt;
  const double order = std::log(error_before / square_error) / std::log(samples / samples_before);
  return samples * std::pow(square_error, 1 / order);
}

bool SampleForecast::rest_takes_more(double most, double samples, double square_error) {
  const auto end = in_the_end(samples, square_error);
  const double rest = end ? *end - samples : samples;
  calls_that_said_so_ = samples > least_share * most && rest > most ? calls_that_said_so_ + 1 : 0;
  return calls_that_said_so_ >= least_calls;
}

}  // namespace halfshade
