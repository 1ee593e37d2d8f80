#include "apps/command_options.h"
#include "apps/scene_turning.h"

#include <CLI/CLI.hpp>

#include <map>

namespace halfshade {
namespace {

void add_size(CLI::App& app, SolveOptions& options) {
  add_elements(app, options.elements, "About how many elements to make");
  app.add_option("--max-length", options.max_length,
                 "Longest element edge in scene units (instead of --elements)")
      ->check(number(false));
  app.add_option("--max-elements", options.max_elements, "Refuse to make more elements than this")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
}

void add_light(CLI::App& app, SolveOptions& options) {
  app.add_option("--bounces", options.radiosity.bounces,
                 "Only light reflected at most N times (default: all)")
      ->check(CLI::Range(0, 100000));
  app.add_option("--rays", options.exchange.rays_per_pair,
                 "Visibility rays for a pair of elements, on average")
      ->capture_default_str()
      ->check(CLI::Range(1, 4096));
  const std::map<std::string, Closure> closures = {
      {"auto", Closure::automatic}, {"enforce", Closure::enforce}, {"leave", Closure::leave}};
  app.add_option(
         "--closure", options.exchange.closure,
         "Scale form factors so that rows sum to 1: 'auto' in closed scenes, 'enforce', 'leave'")
      ->transform(CLI::CheckedTransformer(closures, CLI::ignore_case))
      ->default_str("auto");
  const std::map<std::string, DirectLightBy> direct_lights = {{"auto", DirectLightBy::automatic},
                                                              {"exact", DirectLightBy::exact},
                                                              {"matrix", DirectLightBy::matrix}};
  app.add_option("--direct-light", options.direct_light,
                 "By closed forms ('exact'), like reflected light ('matrix'), or 'auto'")
      ->transform(CLI::CheckedTransformer(direct_lights, CLI::ignore_case))
      ->default_str("auto");
}

void add_curves(CLI::App& app, SolveOptions& options) {
  app.add_flag_callback(
      "--no-discontinuity", [&options] { options.discontinuities = false; },
      "Do not mesh along the curves where the light breaks");
  app.add_option("--tolerance", options.tolerance,
                 "Leave out curves that change the irradiance by less than this share of its mean")
      ->capture_default_str()
      ->check(number(true));
  add_events(app, options.events, options.secondary);
}

}  // namespace

void add_solve(CLI::App& program, SolveCommand& command, CommonOptions& common) {
  CLI::App& app =
      *program.add_subcommand("solve", "Mesh a scene, solve for its radiosity, write the result");
  add_scene(app, command.scene);
  add_outputs(app, command.outputs,
              "Result: .vtu, .vtp, .ply or .png; may repeat (default: SCENE.vtu in this folder)");
  add_materials(app, command.materials,
                "JSON: object, group or material name -> reflectance, exitance, two_sided");
  add_size(app, command.options);
  add_light(app, command.options);
  add_curves(app, command.options);
  add_force(app, command.options.force);
  add_orientation(app, common.orientation);
  add_common(app, common);
  app.footer(footer(
      "Examples:\n"
      "  halfshade solve data/cornell_box.obj -o cornell.vtu -o cornell.ply -o cornell.png\n"
      "  halfshade solve data/l_room.obj --elements 3000 --bounces 1 -o l_room.vtu\n"
      "  halfshade solve data/s1.obj --elements 500 --tolerance 0.05 --events face,ev -o s1.vtu\n"
      "  halfshade solve data/furnace_cube.obj --elements 600 --json report.json -q\n\n"));
}

}  // namespace halfshade
