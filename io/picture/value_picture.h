#pragma once

#include "io/picture/result_file.h"
#include "io/picture/value_range.h"

#include <optional>

namespace halfshade {

struct ValuePictureOptions {
  ValueScale scale = ValueScale::linear;
  std::optional<ValueRange> range;  ///< nothing: robust_range of what is seen
};

/// What is seen of two results of the same scene, at most 128 × 128 places evenly over the picture,
/// on emitters only if there is nothing else.
struct SeenDifference {
  double rms = 0;       ///< root mean square of one minus the other, in the quantity's unit
  double mean = 0;      ///< of one minus the other
  double largest = 0;   ///< of its absolute value
  double relative = 0;  ///< rms over the root mean square of the other; 0 if that is 0
};

/// A picture in false colours, with a legend to its right: it is wider than the options say.
struct ValuePicture {
  Picture picture;
  ValueRange range;  ///< as used
  SeenDifference difference;
};

/// The range that draw_values would take for what the camera sees.
ValueRange seen_range(const ValueMesh& values, const Camera& camera, const PictureOptions& options,
                      ValueScale scale);

/// Draws a quantity in false colours; values beyond the range have the colours of its ends, and the
/// legend says that there are some. Where emitters differ from the rest, as in radiosity, they are
/// left out of the range. Exposure of `options` is of no use here. Otherwise as draw. Throws
/// Error(contract) as draw, and for a range that is empty or, with a logarithmic scale, not above
/// zero.
ValuePicture draw_values(const ValueMesh& values, const Camera& camera,
                         const PictureOptions& options = {}, const ValuePictureOptions& how = {},
                         const Progress& progress = {});

/// Draws one quantity minus another of the same scene, meshed alike or not; zero is in the middle
/// of the range if none is given, and grey. Lines are those of `one`. Throws Error(invalid_input)
/// if the surfaces are not where the other's are, Error(contract) as draw_values and for a
/// logarithmic scale.
ValuePicture draw_difference(const ValueMesh& one, const ValueMesh& other, const Camera& camera,
                             const PictureOptions& options = {},
                             const ValuePictureOptions& how = {}, const Progress& progress = {});

}  // namespace halfshade
