#include "apps/scene_turning.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace halfshade {

void add_orientation(CLI::App& app, SceneOptions& options) {
  app.add_flag("--flip", options.flip, "Reverse all faces of the scene");
  app.add_flag("--orient", options.orient,
               "Turn the faces of closed shells: inwards if a light is in it (else the largest),\n"
               "all others outwards");
}

void add_force(CLI::App& app, ForcedStages& force) {
  app.add_option_function<std::vector<std::string>>(
         "--force",
         [&force](const std::vector<std::string>& names) {
           const auto asked = [&](const char* name) {
             return std::find(names.begin(), names.end(), name) != names.end();
           };
           force = {asked("discontinuities"), asked("eee"), asked("direct-light"), asked("factors"),
                    asked("channels")};
         },
         "Run stages that the scene does not need, separated by commas: discontinuities, eee,\n"
         "direct-light, factors, channels; see explain")
      ->delimiter(',')
      ->check(CLI::IsMember({"discontinuities", "eee", "direct-light", "factors", "channels"}))
      ->type_name("STAGE,…");
}

SceneFile read_turned(const std::filesystem::path& path, const std::filesystem::path& materials,
                      const SceneOptions& options) {
  SceneFile file = read_scene(path, materials);
  file.scene = oriented(std::move(file.scene), options);
  return file;
}

void print_warnings(const std::vector<std::string>& of_file,
                    const std::vector<Warning>& of_result) {
  for (const std::string& warning : of_file) fmt::print(stderr, "warning: {}\n", warning);
  for (const Warning& warning : of_result) fmt::print(stderr, "warning: {}\n", warning.sentence);
}

}  // namespace halfshade
