#pragma once

#include "meshing/core/types.h"

namespace halfshade::detail {

/// What a picture shows where nothing is: linear, a dark grey that is not black.
inline const Rgb background = Rgb::Constant(0.015);

/// The colour of a pixel on an element's edge, linear. Light on dark elements: `element` is the
/// colour of the whole element, lest the line changes along an edge.
inline Rgb with_mesh_line(const Rgb& colour, const Rgb& element) {
  constexpr double opacity = 0.7, dark = 0.02, light_line = 0.1;
  const double line = element.maxCoeff() > dark ? 0.0 : light_line;
  return (1 - opacity) * colour + opacity * line;
}

}  // namespace halfshade::detail
