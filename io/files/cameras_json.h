#pragma once

#include "meshing/core/scene.h"

#include <string>
#include <vector>

namespace halfshade::detail {

/// [{"name", "position", "direction", "up", "vertical_fov"}, …], as in a scene's sidecar, and back.
/// The way back throws std::exception for anything else.
std::string cameras_to_json(const std::vector<Camera>& cameras);
std::vector<Camera> cameras_from_json(const std::string& text);

}  // namespace halfshade::detail
