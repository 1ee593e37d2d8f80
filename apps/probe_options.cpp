#include "apps/command_options.h"
#include "apps/idle_options.h"

#include <CLI/CLI.hpp>

#include <functional>

namespace halfshade {
namespace {

/// Either a table of points or a grid on a group. Returns what says that neither was given.
std::function<void()> add_points(CLI::App& app, ProbeCommand& command) {
  CLI::Option* points =
      add_file(app, "--points", command.points,
               "Table with columns x, y, z, nx, ny, nz; others are kept as they are; '-': stdin");
  CLI::Option* grid = add_text(app, "--grid", command.group,
                               "Points in a square grid on the front of this group instead");
  CLI::Option* spacing =
      add_positive(app, "--spacing", command.spacing, "Spacing of the grid in scene units");
  grid->needs(spacing)->excludes(points);
  spacing->needs(grid);
  return [points, grid] {
    if (points->count() + grid->count() == 0) throw CLI::RequiredError("--points or --grid");
  };
}

}  // namespace

void add_probe(CLI::App& program, ProbeCommand& command, CommonOptions& common) {
  CLI::App& app = *program.add_subcommand(
      "probe", "Compute the irradiance at given points, with exact direct light");
  add_scene(app, command.scene);
  const auto require_points = add_points(app, command);
  add_file(app, "-o,--output", command.output,
           "Result: .csv (the same rows with H_r,H_g,H_b,visible; with --method reference also\n"
           "standard errors H_r_error, …, and direct light D_r, …) or .vtp; '-': .csv to stdout")
      ->required();
  CLI::Option* direct = app.add_flag(
      "--direct", command.direct_only,
      "Only light straight from the emitters; else reflected light is gathered from a\n"
      "solution");
  CLI::Option* tolerance = add_positive(
      app, "--tolerance", command.options.tolerance,
      "Error allowed in that solution, of the irradiance in the L2 norm, relative to it");
  app.callback([require_points, tolerance, &app, &command, &common] {
    require_points();
    if (!command.reference)
      note_idle(app, {{"--samples"}}, "is for random walks (--method reference)", common.notes);
    command.has_tolerance = tolerance->count() > 0;
  });
  CLI::Option* solution = add_file(
      app, "--solution", command.solution,
      "Result of 'solve' for this scene (.vtu, .vtp): reflected light is gathered from it by\n"
      "rays, and nothing is solved for; --tolerance is what it has to be, if given");
  solution->excludes(direct);
  CLI::Option* method = add_choice(
      app, "--method", {"solution", "reference"},
      [&command](std::size_t k) { command.reference = k == 1; },
      "Exact direct light and a solution, or random walks (Monte Carlo) that share nothing with\n"
      "them but the scene, with standard errors");
  solution->excludes(method);
  add_whole(app, "--samples", command.samples, {1, 1000000000},
            "Random walks from each point, with --method reference")
      ->capture_default_str();
  add_materials(app, command.materials, "Materials file, as for solve");
  add_orientation(app, common.orientation);
  add_common(app, common);
  app.footer(
      footer("Examples:\n"
             "  halfshade probe data/s1.obj --points data/s1_points.csv -o s1.csv --direct\n"
             "  halfshade probe data/bars.obj --grid floor --spacing 0.05 -o bars.vtp --direct\n"
             "  halfshade probe data/cornell_box.obj --grid floor --spacing 40 -o cornell.csv "
             "--tolerance 0.02\n"
             "  halfshade probe data/s1.obj --points data/s1_points.csv -o walks.csv --method "
             "reference\n\n"));
}

}  // namespace halfshade
