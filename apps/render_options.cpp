#include "apps/command_options.h"
#include "apps/idle_options.h"
#include "io/files/extension.h"

#include <CLI/CLI.hpp>

#include <array>

namespace halfshade {
namespace {

void add_camera(CLI::App& app, RenderCommand& command) {
  add_text(app, "--camera", command.camera,
           "Camera by name (default: the file's first, or one that fits the scene)");
  add_vector(app, "--position", command.position, "Put the camera here");
  add_vector(app, "--target", command.target, "Look at this point");
  add_vector(app, "--up", command.up, "Upwards in the picture");
  add_number(app, "--fov", command.vertical_fov, {1, 170},
             "Vertical field of view in degrees, with --position")
      ->capture_default_str();
}

void add_picture(CLI::App& app, PictureOptions& options) {
  add_whole(app, "--width", options.width, {1, most_pixels}, "Pixels")->capture_default_str();
  add_whole(app, "--height", options.height, {1, most_pixels}, "Pixels")->capture_default_str();
  add_whole(app, "--samples", options.samples, {1, most_samples}, "Rays per pixel")
      ->capture_default_str();
  add_positive(app, "--exposure", options.exposure,
               "Display value per W/m² (default: from the picture)");
  app.add_flag_callback(
      "--flat", [&options] { options.shading = Shading::flat; }, "One colour an element");
  app.add_flag("--mesh", options.mesh_lines, "Draw the element edges");
}

void add_quantity(CLI::App& app, RenderCommand& command) {
  add_text(app, "--quantity", command.quantity,
           "Draw an array of the result in false colours, with a legend beside the picture:\n"
           "radiosity, irradiance, direct_irradiance, error_estimate, order, region, …")
      ->type_name("ARRAY");
  add_text(app, "--channel", command.channel,
           "Of the array: mean of its components, R, G, B or a number from 0")
      ->type_name("CHANNEL")
      ->capture_default_str();
  add_range(
      app, "--range", command.colours.range,
      "What the colours stand for, with --compare those of the difference (default: 98 % of what\n"
      "is seen)");
  add_choice(
      app, "--scale", {"linear", "log"},
      [&command](std::size_t k) {
        command.colours.scale = std::array{ValueScale::linear, ValueScale::log}.at(k);
      },
      "Of the colours");
  add_file(app, "--curves", command.curves,
           "Draw curves of mesh --curves (.vtp) over it, where they are seen: D0 red, D1 blue,\n"
           "D2 pink, of three edges yellow");
  CLI::Option* compare =
      add_file(app, "--compare", command.compare,
               "Draw INPUT minus this result of the same scene (default --quantity: radiosity)");
  app.add_flag("--side-by-side", command.side_by_side,
               "Draw INPUT, the other and the difference beside each other")
      ->needs(compare);
}

void add_methods(CLI::App& app, RenderCommand& command) {
  add_choice(
      app, "--method", {"drawn", "reference", "classic"},
      [&command](std::size_t k) { command.method = static_cast<RenderMethod>(k); },
      "Of a scene: materials under a lamp ('drawn'), all light by random walks, with its standard\n"
      "error ('reference'), or direct light and a constant, as before radiosity ('classic')");
  add_choice(
      app, "--shadows", {"none", "hard", "soft"},
      [&command](std::size_t k) { command.classic.shadows = static_cast<ClassicShadows>(k); },
      "With --method classic");
  add_not_negative(app, "--ambient", command.classic.ambient,
                   "With --method classic: irradiance in the place of reflected light, W/m²\n"
                   "(default: what emitters send comes to, spread evenly)");
  add_not_negative(app, "--highlight", command.classic.highlight,
                   "With --method classic: share of direct light in a highlight (Phong)");
  add_number(app, "--exponent", command.classic.exponent, {1, 100000},
             "Of the highlight, or the gloss")
      ->capture_default_str();
  app.add_option("--mirror", command.mirrors,
                 "With --method classic: this group or material is a mirror; may repeat")
      ->type_name("NAME");
  add_positive(app, "--lens", command.lens,
               "Radius of a lens, in scene units: what is not at --focus is blurred");
  add_positive(app, "--focus", command.focus, "Distance of what is sharp, with --lens");
  add_vector(
      app, "--move", command.move,
      "Blur by motion: the camera moves so far while the shutter is open, at an even speed,\n"
      "and keeps its direction");
  add_number(app, "--gloss", command.gloss, {0, 1},
             "Of a result: the share that all surfaces reflect in a lobe of --exponent, once");
}

void note_idle_options(const CLI::App& app, const RenderCommand& command,
                       std::vector<std::string>& notes) {
  if (!command.position)
    note_idle(app, {{"--fov"}}, "is of a camera that --position puts somewhere", notes);
  if (!(command.gloss > 0 || command.classic.highlight > 0))
    note_idle(app, {{"--exponent"}}, "is of a lobe; give --highlight or --gloss, too", notes);
  if (command.method != RenderMethod::drawn)
    note_idle(app, {{"--flat"}}, "has no part in traced rays; they see no elements", notes);
  if (!command.compare.empty() && !command.side_by_side)
    note_idle(app, {{"--exposure"}},
              "is of the light itself; a difference takes a --range, or give --side-by-side",
              notes);
  if (has_format(command.input, shaded_formats))
    note_idle(app, {{"--materials"}, {"--flip"}, {"--orient"}},
              "is for scenes; a result has its materials and sides", notes);
}

}  // namespace

void add_render(CLI::App& program, RenderCommand& command, CommonOptions& common) {
  CLI::App& app = *program.add_subcommand(
      "render", "Draw a solution, or a scene, from a camera; needs no display");
  app.add_option("input", command.input, "RESULT.vtu or .vtp of a solve, or a scene")
      ->required()
      ->type_name("INPUT");
  add_file(app, "-o,--output", command.output, "Picture: .png")->required();
  add_materials(app, command.materials, "Materials file, as for solve (scenes only)");
  add_camera(app, command);
  add_picture(app, command.options);
  add_quantity(app, command);
  add_methods(app, command);
  add_orientation(app, common.orientation);
  add_common(app, common);
  app.callback([&app, &command, &common] { note_idle_options(app, command, common.notes); });
  app.footer(footer(
      "Examples:\n"
      "  halfshade render cornell.vtu -o cornell.png --mesh\n"
      "  halfshade render data/dining_room.obj -o room.png --width 1200 --height 800\n"
      "  halfshade render s1.vtu -o s1.png --position 3 3 4 --target 0 0 0 --up 0 0 1\n"
      "  halfshade render s1.vtu -o h.png --quantity irradiance --scale log --width 400 "
      "--height 300\n"
      "  halfshade render data/s1.obj -o walks.png --method reference --samples 16 --width 200 "
      "--height 150\n"
      "  halfshade render data/s1.obj -o phong.png --method classic --shadows hard --highlight "
      "0.2\n\n"));
}

}  // namespace halfshade
