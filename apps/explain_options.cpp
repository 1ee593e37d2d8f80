#include "apps/command_options.h"
#include "apps/idle_options.h"

#include <CLI/CLI.hpp>

namespace halfshade {

void add_explain(CLI::App& program, ExplainCommand& command, CommonOptions& common) {
  CLI::App& app = *program.add_subcommand(
      "explain", "Say what is in a scene, what of it was repaired and what solve would do");
  add_scene(app, command.scene);
  add_materials(app, command.materials, "Materials file, as for solve");
  add_elements(app, command.options.elements,
               "About how many elements to reckon with, with --method matrix");
  add_max_elements(app, command.options.max_elements);
  add_not_negative(app, "--tolerance", command.options.tolerance, "As for solve")
      ->capture_default_str();
  add_whole(app, "--bounces", command.options.radiosity.bounces, {0, 100000}, "As for solve");
  add_solve_method(app, command.options);
  add_visibility(app, command.options);
  add_factors_by(app, command.options.exchange);
  add_force(app, command.options.force);
  add_orientation(app, common.orientation);
  add_common(app, common);
  app.parse_complete_callback([&app, &command, &common] {
    SolveOptions& options = command.options;
    keep_to_limit(app, options);
    note_idle_factors(app, options, common.notes);
    if (options.method == SolveMethod::fields)
      note_idle(app, {{"--elements"}}, "is for constant elements; give --method matrix",
                common.notes);
  });
  app.footer(
      footer("Examples:\n"
             "  halfshade explain data/dining_room.obj\n"
             "  halfshade explain data/s1.obj --force eee --json plan.json\n\n"));
}

}  // namespace halfshade
