#pragma once

#include <stdexcept>
#include <string>

namespace halfshade {

/// What went wrong, as far as a caller can act on it.
enum class ErrorCode {
  usage,          ///< The caller asked for something that does not exist (an unknown format, say).
  invalid_input,  ///< The scene or file cannot be made sound.
  unwritable,     ///< An output could not be written.
  too_large,      ///< The request does not fit into memory.
  contract        ///< A precondition of a function was broken: a mistake in the calling program.
};

/// The one exception of halfshade. `what()` is "place: sentence"; the sentence names ids and
/// values.
class Error : public std::runtime_error {
 public:
  /// `place` is a file, "file:line", the name of a function whose contract was broken, or empty.
  Error(ErrorCode code, std::string place, const std::string& sentence)
      : std::runtime_error(place.empty() ? sentence : place + ": " + sentence),
        code_(code),
        place_(std::move(place)) {}

  ErrorCode code() const { return code_; }
  const std::string& place() const { return place_; }

 private:
  ErrorCode code_;
  std::string place_;
};

}  // namespace halfshade
