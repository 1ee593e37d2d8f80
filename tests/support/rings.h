#pragma once

#include "meshing/core/types.h"

namespace halfshade::test {

inline const Ring unit_square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
inline const Ring square_hole = {{0.4, 0.4}, {0.4, 0.6}, {0.6, 0.6}, {0.6, 0.4}};

}  // namespace halfshade::test
