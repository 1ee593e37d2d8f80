#pragma once

#include <optional>

namespace halfshade {

/// How many samples it takes in the end, as long as the error falls as it last did.
class SampleForecast {
 public:
  /// After so many samples, the square of the error over what is allowed; both > 0. Nothing if it
  /// has not fallen since the last call, or this is the first.
  std::optional<double> in_the_end(double samples, double square_error);

  /// Instead of in_the_end: whether what is still to come is likely to be more than `most` samples.
  /// One call may say so by chance: true only if two in a row do, from a tenth of `most` on. Where
  /// nothing is known of the end, as much is to come as there was.
  bool rest_takes_more(double most, double samples, double square_error);

 private:
  double samples_ = 0, square_error_ = 0;  ///< of the last call
  int calls_that_said_so_ = 0;             ///< in a row
};

}  // namespace halfshade
