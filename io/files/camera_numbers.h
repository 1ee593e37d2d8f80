#pragma once

#include "meshing/core/scene.h"

#include <span>
#include <vector>

namespace halfshade::detail {

/// Numbers of a camera: position, direction, up (x, y, z each), vertical field of view in degrees.
inline constexpr int camera_components = 10;

/// Cameras as numbers, for files whose readers fail on strings: camera_components each in a row,
/// and the bytes of their names, each name ended by a zero.
struct CameraNumbers {
  std::vector<double> values;
  std::vector<int> names;
};

CameraNumbers to_numbers(const std::vector<Camera>& cameras);

/// The way back. Values that make no camera are for the caller to find; names that are not there
/// are empty.
std::vector<Camera> to_cameras(const CameraNumbers& numbers);

}  // namespace halfshade::detail
