#pragma once

#include "meshing/triangulation/curve_mesh.h"

#include <vector>

namespace halfshade::test {

inline const std::vector<Ring> square = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

/// With a notch that reaches far in, and two holes.
inline const std::vector<Ring> notched = {
    {{0, 0}, {1, 0}, {1, 1}, {0.6, 0.3}, {0, 1}},
    {{0.2, 0.2}, {0.2, 0.4}, {0.3, 0.4}, {0.35, 0.2}},
    {{0.7, 0.1}, {0.65, 0.25}, {0.9, 0.2}},
};

inline CurveMeshOptions unrefined() {
  CurveMeshOptions options;
  options.quality.min_angle = 0;
  return options;
}

}  // namespace halfshade::test
