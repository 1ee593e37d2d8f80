#pragma once

#include <optional>

namespace halfshade {

/// How many samples it takes in the end, as long as the error falls as it last did.
class SampleForecast {
 public:
  /// After so many samples, the square of the error over what is allowed; both > 0. Nothing if it
  /// has not fallen since the last call, or this is the first.
  std::optional<double> in_the_end(double samples, double square_error);

 private:
  double samples_ = 0, square_error_ = 0;  ///< of the last call
};

}  // namespace halfshade
