#include "apps/command_options.h"

#include <CLI/CLI.hpp>

#include <array>

namespace halfshade {

void add_orientation(CLI::App& app, SceneOptions& options) {
  app.add_flag("--flip", options.flip, "Reverse all faces of the scene");
  app.add_flag("--orient", options.orient,
               "Turn the faces of closed shells: inwards if a light is in it (else the largest),\n"
               "all others outwards");
}

void add_visibility(CLI::App& app, SolveOptions& options) {
  add_choice(
      app, "--visibility", {"auto", "exact", "sampled"},
      [&options](std::size_t k) {
        options.visibility = std::array{ReflectedVisibility::automatic, ReflectedVisibility::exact,
                                        ReflectedVisibility::sampled}
                                 .at(k);
      },
      "Reflected light by exactly visible parts of surfaces ('exact'), by rays ('sampled'), or\n"
      "by whichever takes less time ('auto'). Direct light is exact, too, unless rays take far\n"
      "less and are as good as the tolerance; 'exact' forbids them");
}

void add_force(CLI::App& app, ForcedStages& force) {
  add_words(
      app, "--force", {"discontinuities", "eee", "direct-light", "factors", "channels"},
      [&force](const std::vector<bool>& asked) {
        force = {asked[0], asked[1], asked[2], asked[3], asked[4]};
      },
      "Run stages that the scene does not need, separated by commas: discontinuities, eee,\n"
      "direct-light, factors, channels; see explain")
      ->type_name("STAGE,…");
}

}  // namespace halfshade
