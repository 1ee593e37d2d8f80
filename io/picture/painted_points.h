#pragma once

#include "io/picture/picture.h"

#include <vector>

namespace halfshade::detail {

/// Gives painted triangles points of their own, with irradiance times the triangle's mean
/// reflectance, which the gain of its paint undoes: radiosities around a point that triangles share
/// are of different parts of the picture. `irradiance` is of each point, `reflectance` of each
/// triangle.
void separate_painted(const std::vector<Rgb>& irradiance, const std::vector<Rgb>& reflectance,
                      ShadedMesh& mesh);

}  // namespace halfshade::detail
