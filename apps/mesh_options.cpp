#include "apps/command_options.h"
#include "apps/idle_options.h"

#include <CLI/CLI.hpp>

namespace halfshade {
namespace {

void add_picture(CLI::App& app, MeshCommand& command) {
  CLI::Option* picture =
      add_file(app, "--picture", command.picture,
               "Map of the curves over the exact direct light of one surface: .png");
  add_text(app, "--of", command.picture_of,
           "Group or number of the surface to draw (default: where most curves are)")
      ->needs(picture);
  add_choice(
      app, "--colour", {"order", "kind"},
      [&command](std::size_t k) {
        command.picture_options.colour = k == 0 ? CurveColour::order : CurveColour::kind;
      },
      "By 'order' (D0 red, D1 blue, D2 pink, D2 of three edges yellow) or by 'kind'\n"
      "(contact red, face green, ev pink, eee yellow, horizon teal)")
      ->needs(picture);
  add_whole(app, "--pixels", command.picture_options.pixels, {least_curve_pixels, most_pixels},
            "Longer side of the picture")
      ->needs(picture)
      ->capture_default_str();
}

}  // namespace

void add_mesh(CLI::App& program, MeshCommand& command, CommonOptions& common) {
  CLI::App& app = *program.add_subcommand(
      "mesh",
      "Find the curves where the light breaks and mesh a scene along them, without solving");
  add_scene(app, command.scene);
  add_outputs(app, command.outputs,
              "Mesh: .vtu, .vtp or .ply; may repeat (default: SCENE.vtu in this folder, unless "
              "--curves or --picture is given)");
  add_file(app, "--curves", command.curves, "The curves with kind, order, jump and origin: .vtp");
  add_materials(app, command.materials, "Materials file, as for solve");
  const CLI::Option* tolerance = add_not_negative(
      app, "--tolerance", command.options.tolerance,
      "Leave out curves that change the irradiance by less than this share of its mean,\n"
      "and draw conics accordingly (default: 0, the mesh is complete)");
  app.callback([tolerance, &app, &command, &common] {
    command.has_tolerance = tolerance->count() > 0;
    const bool only_curves = !command.curves.empty() || !command.picture.empty();
    if (!only_curves || !command.outputs.empty() || is_given(app, "--json")) return;
    const char* const why = "is of elements, and only curves are asked for; give -o, too";
    note_idle(app, {{"--deviation"}}, why, common.notes);
    // With one, curves are judged by what they do in elements of this length.
    if (!(command.options.tolerance > 0)) note_idle(app, {{"--max-length"}}, why, common.notes);
  });
  add_positive(app, "--max-length", command.options.max_length,
               "Longest element edge in scene units (default: no limit)");
  add_events(app, command.options.events, command.options.secondary);
  add_deviation(app, command.options.deviation);
  add_picture(app, command);
  add_orientation(app, common.orientation);
  add_common(app, common);
  app.footer(footer(
      "Examples:\n"
      "  halfshade mesh data/s1.obj -o s1_mesh.vtu --curves s1_curves.vtp --json s1_mesh.json\n"
      "  halfshade mesh data/skew_bars.obj --picture skew_bars.png --of floor --colour kind\n"
      "  halfshade mesh data/cornell_box.obj --tolerance 0.01 --max-length 100 -o "
      "cornell_mesh.vtu\n"
      "  halfshade mesh data/bars.obj --events contact,face,ev --curves bars.vtp\n\n"));
}

}  // namespace halfshade
