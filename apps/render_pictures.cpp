#include "apps/render_pictures.h"

#include "io/picture/radiance_picture.h"
#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

[[noreturn]] void refuse(const std::string& sentence) {
  throw Error(ErrorCode::usage, "render", sentence);
}

Camera named_camera(const ShadedMesh& mesh, const RenderCommand& command) {
  if (command.camera.empty()) return default_camera(mesh);
  const auto found = std::find_if(mesh.cameras.begin(), mesh.cameras.end(),
                                  [&](const Camera& c) { return c.name == command.camera; });
  if (found != mesh.cameras.end()) return *found;
  std::string names;
  for (const Camera& camera : mesh.cameras) names += (names.empty() ? "" : ", ") + camera.name;
  throw Error(ErrorCode::usage, command.input.string(),
              fmt::format("there is no camera '{}'; the file has {}", command.camera,
                          names.empty() ? "none" : names));
}

void require_meaning_of_colours(const RenderCommand& command) {
  const bool is_false = !command.quantity.empty() || !command.compare.empty();
  const ValuePictureOptions& colours = command.colours;
  if (!is_false && (colours.range || colours.scale == ValueScale::log || command.channel != "mean"))
    refuse("--range, --scale and --channel are of false colours: give --quantity, too");
  if (colours.range && colours.scale == ValueScale::log && !(colours.range->low > 0))
    refuse("--range must begin above zero where --scale is log");
  if (!command.compare.empty() && colours.scale == ValueScale::log)
    refuse("differences have no logarithmic scale");
  if (!command.quantity.empty() && command.options.exposure > 0)
    refuse("--exposure is of the light itself; --quantity takes a --range");
}

void require_meaning_of_radiance(const RenderCommand& command) {
  if (!has_format(command.output, radiance_formats)) return;
  if (!has_format(command.input, shaded_formats) && command.method == RenderMethod::drawn)
    refuse("a scene has no radiance before it is solved; give the result of solve, or write .png");
  if (!command.quantity.empty() || !command.compare.empty() || !command.curves.empty() ||
      command.options.mesh_lines || command.options.exposure > 0)
    refuse(
        ".hdr holds radiance as it is; --quantity, --compare, --curves, --mesh and --exposure make "
        "a .png");
}

void require_meaning_of_method(const RenderCommand& command) {
  const bool is_traced = command.method != RenderMethod::drawn;
  if (is_traced && has_format(command.input, shaded_formats))
    refuse("--method traces rays through a scene; give the scene, not its result");
  if (is_traced && (!command.curves.empty() || command.options.mesh_lines))
    refuse("--mesh and --curves are drawn over results, not over traced rays");
  const bool distributed = is_distributed(command);
  if (distributed && !is_traced && !has_format(command.input, shaded_formats))
    refuse(
        "--lens, --move and --gloss are of light: give a result, or --method reference or classic");
  if (distributed && (!command.quantity.empty() || !command.compare.empty() ||
                      !command.curves.empty() || command.options.mesh_lines))
    refuse(
        "--lens, --move and --gloss are of the light itself, without --quantity, --compare or "
        "lines");
  if ((command.lens > 0) != (command.focus > 0))
    refuse("--lens, its radius, and --focus, the distance of what is sharp, go together");
  if (command.gloss > 0 && is_traced)
    refuse("--gloss is of results; --method classic has --highlight and --mirror");
  const ClassicOptions usual;
  const bool has_classic = command.classic.shadows != usual.shadows ||
                           command.classic.ambient >= 0 || command.classic.highlight > 0 ||
                           !command.mirrors.empty();
  if (has_classic && command.method != RenderMethod::classic)
    refuse("--shadows, --ambient, --highlight and --mirror are of --method classic");
}

std::string difference_name(const RenderCommand& command) {
  return command.quantity.empty() ? "radiosity" : command.quantity;
}

/// Both results with the same exposure.
std::array<Picture, 2> both_lights(const ResultFile& one, const ResultFile& other,
                                   const Camera& camera, const PictureOptions& options,
                                   const Progress& progress) {
  PictureOptions same = options;
  Picture first = draw(shaded(one), camera, same, progress);
  same.exposure = first.exposure;
  Picture second = draw(shaded(other), camera, same, progress);
  return {std::move(first), std::move(second)};
}

/// Both in the same colours.
std::array<Picture, 2> both_quantities(const ValueMesh& one, const ValueMesh& other,
                                       const Camera& camera, const RenderCommand& command,
                                       const PictureOptions& options, const Progress& progress) {
  const ValueRange a = seen_range(one, camera, options, ValueScale::linear);
  const ValueRange b = seen_range(other, camera, options, ValueScale::linear);
  ValuePictureOptions same = command.colours;
  same.range = ValueRange{std::min(a.low, b.low), std::max(a.high, b.high)};
  return {draw_values(one, camera, options, same, progress).picture,
          draw_values(other, camera, options, same, progress).picture};
}

PictureOptions with_curves(const RenderCommand& command) {
  PictureOptions options = command.options;
  if (!command.curves.empty()) options.curves = read_curves(command.curves);
  return options;
}

}  // namespace

bool is_distributed(const RenderCommand& command) {
  return command.lens > 0 || command.move || command.gloss > 0;
}

void require_meaning(const RenderCommand& command) {
  require_meaning_of_method(command);
  if (!has_format(command.input, shaded_formats) &&
      (!command.quantity.empty() || !command.compare.empty()))
    refuse("a scene has no quantities before it is solved; give the result of solve or mesh");
  require_meaning_of_colours(command);
  require_meaning_of_radiance(command);
}

Camera chosen_camera(const ShadedMesh& mesh, const RenderCommand& command) {
  Camera camera = named_camera(mesh, command);
  if (command.position) {
    camera.position = *command.position;
    camera.vertical_fov = command.vertical_fov;
  }
  if (command.target) camera.direction = *command.target - camera.position;
  if (command.up) camera.up = *command.up;
  if (!(camera.direction.cross(camera.up).norm() >
        least_sine * camera.direction.norm() * camera.up.norm()))
    refuse("the camera looks along its up vector or nowhere; give another --up or --target");
  return camera;
}

Rendering render_light(const ShadedMesh& mesh, const RenderCommand& command,
                       const Progress& progress) {
  const Camera camera = chosen_camera(mesh, command);
  Rendering result;
  result.picture = draw(mesh, camera, with_curves(command), progress);
  result.report = {
      result.picture.width, result.picture.height, result.picture.exposure, camera, {}, {}, {}};
  return result;
}

Rendering render_quantity(const ResultFile& file, const RenderCommand& command,
                          const Progress& progress) {
  const ValueMesh values = quantity_of(file, command.quantity, command.channel);
  const Camera camera = chosen_camera(values.mesh, command);
  ValuePicture drawn = draw_values(values, camera, with_curves(command), command.colours, progress);
  Rendering result{std::move(drawn.picture), {}};
  result.report = {result.picture.width, result.picture.height, 0, camera,
                   values.quantity,      drawn.range,           {}};
  return result;
}

Rendering render_difference(const ResultFile& one, const ResultFile& other,
                            const RenderCommand& command, const Progress& progress) {
  const std::string name = difference_name(command);
  const ValueMesh a = quantity_of(one, name, command.channel);
  const ValueMesh b = quantity_of(other, name, command.channel);
  const Camera camera = chosen_camera(a.mesh, command);
  const PictureOptions options = with_curves(command);
  ValuePicture drawn = draw_difference(a, b, camera, options, command.colours, progress);
  Rendering result{std::move(drawn.picture), {}};
  double exposure = 0;
  if (command.side_by_side) {
    std::array<Picture, 2> both = command.quantity.empty()
                                      ? both_lights(one, other, camera, options, progress)
                                      : both_quantities(a, b, camera, command, options, progress);
    exposure = both[0].exposure;
    const std::array<std::string, 3> titles = {one.path.filename().string(),
                                               other.path.filename().string(), "difference"};
    result.picture = beside(
        std::array{std::move(both[0]), std::move(both[1]), std::move(result.picture)}, titles);
  }
  result.report = {result.picture.width, result.picture.height, exposure,        camera,
                   a.quantity,           drawn.range,           drawn.difference};
  return result;
}

}  // namespace halfshade
