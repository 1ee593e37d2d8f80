#include "apps/command_options.h"
#include "apps/idle_options.h"

#include <CLI/CLI.hpp>

#include <array>

namespace halfshade {

void add_factors(CLI::App& program, FactorsCommand& command, CommonOptions& common) {
  CLI::App& app = *program.add_subcommand(
      "factors", "Compute the matrix of form factors (view factors) between surfaces");
  FactorOptions& options = command.options;
  add_scene(app, command.scene);
  add_file(
      app, "-o,--output", command.output,
      "Result: .csv (surface,area,NAME…,space,row_sum,error), .mtx (MatrixMarket, with names,\n"
      "areas and places beside it in .names.csv); '-': .csv to stdout")
      ->required();
  CLI::Option* from = add_file(
      app, "--from", command.from,
      "Sum a matrix by face of this scene that was saved (.mtx) instead of computing it again");
  add_choice(
      app, "--by", {"group", "face", "material"},
      [&options](std::size_t k) {
        options.unit = std::array{FactorUnit::group, FactorUnit::face, FactorUnit::material}.at(k);
      },
      "What has a row");
  add_number(app, "--tolerance", options.tolerance, {1e-12, 0.5},
             "Error allowed in a form factor, absolute")
      ->capture_default_str()
      ->excludes(from);
  add_choice(
      app, "--method", {"auto", "exact", "rays", "hemicube"},
      [&options](std::size_t k) { options.method = static_cast<FactorMethod>(k); },
      "Closed forms and exactly visible parts, counted rays, or item buffers; by default exact,\n"
      "unless that is a lot of work and rays reach the tolerance with a fraction of it")
      ->excludes(from);
  add_whole(app, "--rays", options.rays, {1, 1000000000},
            "Rays of each row, with --method rays (default: as many as the tolerance takes);\n"
            "pixels of each row, with hemicube (default: 10000)")
      ->excludes(from);
  add_even(
      app, "--hemicube", options.hemicube_pixels, {2, 4096},
      "Pixels along an edge of hemicubes, with --method hemicube; at least four stand on a surface")
      ->capture_default_str()
      ->excludes(from);
  add_not_negative(
      app, "--sparse-below", options.sparse_below,
      "Leave out form factors that cannot reach this, and say so in 'error' and a comment");
  app.add_flag(
      "--enforce", options.enforce,
      "Scale rows and columns alike until rows, with space, sum to one; what --sparse-below\n"
      "left out is made up for by the rest");
  add_whole(app, "--max-points", options.max_points, {1, 1000000000},
            "Points at which a pair of surfaces is looked at, at most, with --method exact")
      ->capture_default_str()
      ->excludes(from);
  app.callback([&app, &options, &common] {
    const auto note = [&](const char* name, const char* why) {
      note_idle(app, {{name}}, why, common.notes);
    };
    const bool is_by_rays = options.method == FactorMethod::rays,
               is_by_cubes = options.method == FactorMethod::hemicube;
    if (!is_by_rays && !is_by_cubes) note("--rays", "is for --method rays or hemicube");
    if (!is_by_cubes) note("--hemicube", "is for --method hemicube");
    if (is_by_rays || is_by_cubes) note("--max-points", "is for --method exact");
    if (is_by_cubes)
      note("--tolerance", "is for --method exact or rays; --rays says how much hemicubes do");
    if (is_by_rays && options.rays > 0) note("--tolerance", "has no part in a number of --rays");
  });
  add_materials(app, command.materials, "Materials file, as for solve");
  add_orientation(app, common.orientation);
  add_common(app, common);
  app.footer(footer(
      "Examples:\n"
      "  halfshade factors data/l_room.obj -o l_room.csv\n"
      "  halfshade factors data/l_room.obj -o l_room.mtx --by face --tolerance 1e-6\n"
      "  halfshade factors data/l_room.obj --from l_room.mtx -o l_room_groups.csv --enforce\n"
      "  halfshade factors data/furnace_cube.obj -o - --by material --tolerance 1e-9\n"
      "  halfshade factors data/table_and_chairs.obj -o chairs.csv --method rays --rays "
      "20000 --enforce\n\n"));
}

}  // namespace halfshade
