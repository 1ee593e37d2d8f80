#include "apps/command_options.h"

#include <CLI/CLI.hpp>

#include <array>

namespace halfshade {
namespace {

void add_size(CLI::App& app, SolveOptions& options) {
  add_elements(app, options.elements, "About how many elements to make");
  add_positive(app, "--max-length", options.max_length,
               "Longest element edge in scene units (instead of --elements)");
  add_whole(app, "--max-elements", options.max_elements, {1, 1000000},
            "Refuse to make more elements than this")
      ->capture_default_str();
}

void add_light(CLI::App& app, SolveOptions& options) {
  add_whole(app, "--bounces", options.radiosity.bounces, {0, 100000},
            "Only light that arrives after at most N reflections: 0 is direct light, 1 adds one\n"
            "reflection (default: all)");
  app.add_flag("--regions", options.regions,
               "Say of each element whether it is lit, in penumbra or umbra of each emitter");
  add_whole(app, "--rays", options.exchange.rays_per_pair, {1, 4096},
            "Visibility rays for a pair of elements, on average")
      ->capture_default_str();
  add_choice(
      app, "--closure", {"auto", "enforce", "leave"},
      [&options](std::size_t k) {
        options.exchange.closure =
            std::array{Closure::automatic, Closure::enforce, Closure::leave}.at(k);
      },
      "Scale form factors so that rows sum to 1: 'auto' in closed scenes, 'enforce', 'leave'");
  add_choice(
      app, "--direct-light", {"auto", "exact", "matrix"},
      [&options](std::size_t k) {
        options.direct_light =
            std::array{DirectLightBy::automatic, DirectLightBy::exact, DirectLightBy::matrix}.at(k);
      },
      "By closed forms ('exact'), like reflected light ('matrix'), or 'auto'");
}

void add_curves(CLI::App& app, SolveOptions& options) {
  app.add_flag_callback(
      "--no-discontinuity", [&options] { options.discontinuities = false; },
      "Do not mesh along the curves where the light breaks");
  add_not_negative(
      app, "--tolerance", options.tolerance,
      "Leave out curves that change the irradiance by less than this share of its mean")
      ->capture_default_str();
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
