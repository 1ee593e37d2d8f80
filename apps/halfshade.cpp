#include "apps/commands.h"
#include "apps/interrupt.h"
#include "apps/progress_bar.h"
#include "meshing/core/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <new>
#include <thread>

namespace halfshade {
namespace {

constexpr const char* exit_code_help =
    "Exit codes: 0 done, 2 wrong usage, 3 invalid input, 4 finished but not as accurate as asked,\n"
    "5 could not write, 130 interrupted (what was computed so far is written and marked).";

int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return exit_usage;
    case ErrorCode::unwritable:
      return exit_unwritable;
    case ErrorCode::invalid_input:
    case ErrorCode::too_large:
    case ErrorCode::contract:
      break;
  }
  return exit_invalid_input;
}

void add_common(CLI::App& app, CommonOptions& common) {
  app.add_flag("-q,--quiet", common.quiet, "Print errors only");
  app.add_flag("-v,--verbose", common.verbose, "Print repairs and the time of each stage");
  app.add_option("--threads", common.threads, "Number of threads (default: all of the machine)")
      ->check(CLI::Range(1, 4096));
  app.add_option("--json", common.json, "Write a machine-readable report to FILE")
      ->type_name("FILE");
}

/// A number that is finite and at least zero, or above it; CLI11's own checks let NaN pass.
CLI::Validator number(bool zero_too) {
  return {[zero_too](const std::string& text) -> std::string {
            double value = -1;
            if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) &&
                (value > 0 || (zero_too && value == 0)))
              return {};
            return fmt::format("'{}' is not a number {} zero", text,
                               zero_too ? "of at least" : "above");
          },
          zero_too ? "NUMBER >= 0" : "NUMBER > 0"};
}

/// Which discontinuities to look for.
void add_events(CLI::App& app, DiscontinuityOptions& events, int& secondary) {
  app.add_option_function<std::vector<std::string>>(
         "--events",
         [&events](const std::vector<std::string>& names) {
           const auto asked = [&](const char* name) {
             return std::find(names.begin(), names.end(), name) != names.end();
           };
           events = {asked("contact"), asked("face"), asked("ev"), asked("eee")};
         },
         "Only lines of these kinds, separated by commas: contact, face, ev, eee (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"contact", "face", "ev", "eee"}))
      ->type_name("KIND,…");
  app.add_option("--secondary", secondary,
                 "Also look for the lines of the N brightest reflecting surfaces")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000000));
}

void add_solve(CLI::App& program, SolveCommand& command, CommonOptions& common) {
  CLI::App* app =
      program.add_subcommand("solve", "Mesh a scene, solve for its radiosity, write the result");
  app->add_option("scene", command.scene, "Scene: .obj, .ply, .off, .gltf, .glb, .stl, …")
      ->required()
      ->type_name("SCENE");
  app->add_option(
         "-o,--output", command.outputs,
         "Result: .vtu, .vtp, .ply or .png; may repeat (default: SCENE.vtu in this folder)")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app->add_option("--materials", command.materials,
                  "JSON: object, group or material name -> reflectance, exitance, two_sided")
      ->type_name("FILE");
  auto& options = command.options;
  app->add_option("--elements", options.elements, "About how many elements to make")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app->add_option("--max-length", options.max_length,
                  "Longest element edge in scene units (instead of --elements)")
      ->check(number(false));
  app->add_option("--max-elements", options.max_elements, "Refuse to make more elements than this")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app->add_option("--bounces", options.radiosity.bounces,
                  "Only light reflected at most N times (default: all)")
      ->check(CLI::Range(0, 100000));
  app->add_option("--rays", options.exchange.rays_per_pair,
                  "Visibility rays for a pair of elements, on average")
      ->capture_default_str()
      ->check(CLI::Range(1, 4096));
  const std::map<std::string, Closure> closures = {
      {"auto", Closure::automatic}, {"enforce", Closure::enforce}, {"leave", Closure::leave}};
  app->add_option(
         "--closure", options.exchange.closure,
         "Scale form factors so that rows sum to 1: 'auto' in closed scenes, 'enforce', 'leave'")
      ->transform(CLI::CheckedTransformer(closures, CLI::ignore_case))
      ->default_str("auto");
  const std::map<std::string, DirectLightBy> direct_lights = {{"auto", DirectLightBy::automatic},
                                                              {"exact", DirectLightBy::exact},
                                                              {"matrix", DirectLightBy::matrix}};
  app->add_option("--direct-light", options.direct_light,
                  "By closed forms ('exact'), like reflected light ('matrix'), or 'auto'")
      ->transform(CLI::CheckedTransformer(direct_lights, CLI::ignore_case))
      ->default_str("auto");
  app->add_flag_callback(
      "--no-discontinuity", [&options] { options.discontinuities = false; },
      "Do not mesh along the lines where the light breaks");
  app->add_option("--tolerance", options.tolerance,
                  "Leave out lines that change the irradiance by less than this share of its mean")
      ->capture_default_str()
      ->check(number(true));
  add_events(*app, options.events, options.secondary);
  add_common(*app, common);
  app->footer(
      "Examples:\n"
      "  halfshade solve data/cornell_box.obj -o cornell.vtu -o cornell.ply -o cornell.png\n"
      "  halfshade solve data/l_room.obj --elements 3000 --bounces 1 -o l_room.vtu\n"
      "  halfshade solve data/s1.obj --elements 500 --tolerance 0.05 --events face,ev -o s1.vtu\n"
      "  halfshade solve data/furnace_cube.obj --elements 600 --json report.json -q\n\n" +
      std::string(exit_code_help));
}

void add_mesh(CLI::App& program, MeshCommand& command, CommonOptions& common) {
  CLI::App* app = program.add_subcommand(
      "mesh", "Find the lines where the light breaks and mesh a scene along them, without solving");
  app->add_option("scene", command.scene, "Scene: .obj, .ply, .off, .gltf, .glb, .stl, …")
      ->required()
      ->type_name("SCENE");
  app->add_option("-o,--output", command.outputs,
                  "Mesh: .vtu, .vtp or .ply; may repeat (default: SCENE.vtu in this folder, unless "
                  "--curves or --picture is given)")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app->add_option("--curves", command.curves, "The lines with kind, order, jump and origin: .vtp")
      ->type_name("FILE");
  app->add_option("--materials", command.materials, "Materials file, as for solve")
      ->type_name("FILE");
  auto& options = command.options;
  app->add_option(
         "--tolerance", options.tolerance,
         "Leave out lines that change the irradiance by less than this share of its mean,\n"
         "and draw conics accordingly (default: 0, the mesh is complete)")
      ->check(number(true));
  app->add_option("--max-length", options.max_length,
                  "Longest element edge in scene units (default: no limit)")
      ->check(number(false));
  add_events(*app, options.events, options.secondary);
  CLI::Option* picture =
      app->add_option("--picture", command.picture,
                      "Map of the lines over the exact direct light of one surface: .png")
          ->type_name("FILE");
  app->add_option("--of", command.picture_of,
                  "Group or number of the surface to draw (default: where most lines are)")
      ->needs(picture)
      ->type_name("NAME");
  const std::map<std::string, CurveColour> colours = {{"order", CurveColour::order},
                                                      {"kind", CurveColour::kind}};
  app->add_option("--colour", command.picture_options.colour,
                  "By 'order' (D0 red, D1 blue, D2 pink, D2 of three edges yellow) or by 'kind'\n"
                  "(contact red, face green, ev pink, eee yellow)")
      ->needs(picture)
      ->transform(CLI::CheckedTransformer(colours, CLI::ignore_case))
      ->default_str("order");
  app->add_option("--pixels", command.picture_options.pixels, "Longer side of the picture")
      ->needs(picture)
      ->capture_default_str()
      ->check(CLI::Range(16, 16384));
  add_common(*app, common);
  app->footer(
      "Examples:\n"
      "  halfshade mesh data/s1.obj -o s1_mesh.vtu --curves s1_curves.vtp --json s1_mesh.json\n"
      "  halfshade mesh data/skew_bars.obj --picture skew_bars.png --of floor --colour kind\n"
      "  halfshade mesh data/cornell_box.obj --tolerance 0.01 --max-length 100 -o "
      "cornell_mesh.vtu\n"
      "  halfshade mesh data/bars.obj --events contact,face,ev --curves bars.vtp\n\n" +
      std::string(exit_code_help));
}

void add_vector(CLI::App& app, const char* name, std::optional<Vec3>& target, const char* help) {
  app.add_option_function<std::vector<double>>(
         name, [&target](const std::vector<double>& v) { target = Vec3(v[0], v[1], v[2]); }, help)
      ->expected(3)
      ->type_name("X Y Z");
}

void add_render(CLI::App& program, RenderCommand& command, CommonOptions& common) {
  CLI::App* app = program.add_subcommand(
      "render", "Draw a solution, or a scene, from a camera; needs no display");
  app->add_option("input", command.input, "RESULT.vtu or .vtp of a solve, or a scene")
      ->required()
      ->type_name("INPUT");
  app->add_option("-o,--output", command.output, "Picture: .png")->required()->type_name("FILE");
  app->add_option("--materials", command.materials, "Materials file, as for solve (scenes only)")
      ->type_name("FILE");
  app->add_option("--camera", command.camera,
                  "Camera by name (default: the file's first, or one that fits the scene)");
  add_vector(*app, "--position", command.position, "Put the camera here");
  add_vector(*app, "--target", command.target, "Look at this point");
  add_vector(*app, "--up", command.up, "Upwards in the picture");
  app->add_option("--fov", command.vertical_fov,
                  "Vertical field of view in degrees, with --position")
      ->capture_default_str()
      ->check(CLI::Range(1., 170.));
  auto& options = command.options;
  app->add_option("--width", options.width, "Pixels")
      ->capture_default_str()
      ->check(CLI::Range(1, 16384));
  app->add_option("--height", options.height, "Pixels")
      ->capture_default_str()
      ->check(CLI::Range(1, 16384));
  app->add_option("--samples", options.samples, "Rays per pixel")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  app->add_option("--exposure", options.exposure,
                  "Display value per W/m² (default: from the picture)")
      ->check(CLI::PositiveNumber);
  app->add_flag_callback(
      "--flat", [&options] { options.shading = Shading::flat; }, "One colour an element");
  app->add_flag("--mesh", options.mesh_lines, "Draw the element edges");
  add_common(*app, common);
  app->footer(
      "Examples:\n"
      "  halfshade render cornell.vtu -o cornell.png --mesh\n"
      "  halfshade render data/dining_room.obj -o room.png --width 1200 --height 800\n"
      "  halfshade render s1.vtu -o s1.png --position 3 3 4 --target 0 0 0 --up 0 0 1\n\n" +
      std::string(exit_code_help));
}

void add_probe(CLI::App& program, ProbeCommand& command, CommonOptions& common) {
  CLI::App* app = program.add_subcommand(
      "probe", "Compute the irradiance at given points, with exact direct light");
  app->add_option("scene", command.scene, "Scene: .obj, .ply, .off, .gltf, .glb, .stl, …")
      ->required()
      ->type_name("SCENE");
  CLI::Option* points =
      app->add_option("--points", command.points,
                      "Table with columns x, y, z, nx, ny, nz; others are kept as they are")
          ->type_name("FILE");
  CLI::Option* grid = app->add_option("--grid", command.group,
                                      "Points in a square grid on the front of this group instead")
                          ->type_name("GROUP");
  CLI::Option* spacing =
      app->add_option("--spacing", command.spacing, "Spacing of the grid in scene units")
          ->check(CLI::PositiveNumber);
  grid->needs(spacing)->excludes(points);
  spacing->needs(grid);
  app->add_option("-o,--output", command.output,
                  "Result: .csv (the same rows with H_r,H_g,H_b,visible) or .vtp")
      ->required()
      ->type_name("FILE");
  app->add_flag("--direct", command.direct_only,
                "Only light straight from the emitters; else interreflection is gathered from a\n"
                "solution by closed-form factors, with visibility by rays");
  app->add_option("--elements", command.options.elements,
                  "About how many elements to solve with, without --direct")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app->add_option("--materials", command.materials, "Materials file, as for solve")
      ->type_name("FILE");
  add_common(*app, common);
  app->footer(
      "Examples:\n"
      "  halfshade probe data/s1.obj --points data/s1_points.csv -o s1.csv --direct\n"
      "  halfshade probe data/bars.obj --grid floor --spacing 0.05 -o bars.vtp --direct\n"
      "  halfshade probe data/cornell_box.obj --grid floor --spacing 40 -o cornell.csv --elements "
      "1000\n\n" +
      std::string(exit_code_help));
  app->callback([points, grid] {
    if (points->count() + grid->count() == 0) throw CLI::RequiredError("--points or --grid");
  });
}

std::string joined(int argc, char** argv) {
  std::string line;
  for (int k = 0; k < argc; ++k) line += (k ? " " : "") + std::string(argv[k]);
  return line;
}

int run_program(int argc, char** argv) {
  CLI::App program("halfshade: discontinuity meshing and accurate radiosity");
  program.name("halfshade");
  program.set_version_flag("--version", HALFSHADE_VERSION);
  program.require_subcommand(1);
  program.footer("Each command has --help with examples.\n" + std::string(exit_code_help));
  Context context;
  SolveCommand solve_command;
  MeshCommand mesh_command;
  RenderCommand render_command;
  ProbeCommand probe_command;
  add_solve(program, solve_command, context.common);
  add_mesh(program, mesh_command, context.common);
  add_render(program, render_command, context.common);
  add_probe(program, probe_command, context.common);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return program.exit(e) == 0 ? exit_done : exit_usage;
  }
  const Interrupt interrupt;
  const int hardware = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const tbb::global_control threads(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(context.common.threads > 0 ? context.common.threads : hardware));
  ProgressBar bar(!context.common.quiet);
  context.provenance = {HALFSHADE_VERSION, joined(argc, argv)};
  context.progress = {interrupt.token(), [&bar](std::string_view stage, double fraction) {
                        bar.update(stage, fraction);
                      }};
  context.progress_ends = [&bar] { bar.clear(); };
  if (program.got_subcommand("solve")) return run(solve_command, context);
  if (program.got_subcommand("mesh")) return run(mesh_command, context);
  if (program.got_subcommand("probe")) return run(probe_command, context);
  return run(render_command, context);
}

}  // namespace
}  // namespace halfshade

int main(int argc, char** argv) {
  try {
    return halfshade::run_program(argc, argv);
  } catch (const halfshade::Error& e) {
    fmt::print(stderr, "halfshade: {}\n", e.what());
    return halfshade::exit_code(e.code());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr,
               "halfshade: the machine has not enough memory for this; ask for fewer elements\n");
    return halfshade::exit_invalid_input;
  } catch (const std::exception& e) {
    fmt::print(stderr, "halfshade: {}\n", e.what());
    return halfshade::exit_invalid_input;
  }
}
