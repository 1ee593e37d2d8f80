#pragma once

#include "io/read/read_scene.h"
#include "meshing/repair/orientation.h"
#include "solver/pipeline/solve_options.h"
#include "solver/pipeline/warnings.h"

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace halfshade {

/// Adds --flip and --orient.
void add_orientation(CLI::App& app, SceneOptions& options);

/// Adds --force.
void add_force(CLI::App& app, ForcedStages& force);

/// A scene as read, its faces turned as asked for.
SceneFile read_turned(const std::filesystem::path& path, const std::filesystem::path& materials,
                      const SceneOptions& options);

/// One line each on the standard error.
void print_warnings(const std::vector<std::string>& of_file, const std::vector<Warning>& of_result);

}  // namespace halfshade
