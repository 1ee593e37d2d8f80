#include "apps/check_outputs.h"
#include "apps/commands.h"
#include "apps/scene_turning.h"
#include "meshing/core/error.h"
#include "meshing/repair/repair.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

ShadedMesh load(const RenderCommand& command, const SceneOptions& orientation) {
  if (has_format(command.input, shaded_formats)) return read_shaded(command.input);
  const SceneFile file = read_turned(command.input, command.materials, orientation);
  return shaded(make_sound(file.scene), file.scene.cameras);
}

Camera named_camera(const ShadedMesh& mesh, const RenderCommand& command) {
  if (command.camera.empty())
    return mesh.cameras.empty() ? fitting_camera(mesh) : mesh.cameras.front();
  const auto found = std::find_if(mesh.cameras.begin(), mesh.cameras.end(),
                                  [&](const Camera& c) { return c.name == command.camera; });
  if (found != mesh.cameras.end()) return *found;
  std::string names;
  for (const Camera& camera : mesh.cameras) names += (names.empty() ? "" : ", ") + camera.name;
  throw Error(ErrorCode::usage, command.input.string(),
              fmt::format("there is no camera '{}'; the file has {}", command.camera,
                          names.empty() ? "none" : names));
}

Camera choose_camera(const ShadedMesh& mesh, const RenderCommand& command) {
  Camera camera = named_camera(mesh, command);
  if (command.position) {
    camera.position = *command.position;
    camera.vertical_fov = command.vertical_fov;
  }
  if (command.target) camera.direction = *command.target - camera.position;
  if (command.up) camera.up = *command.up;
  if (!(camera.direction.cross(camera.up).norm() >
        least_sine * camera.direction.norm() * camera.up.norm()))
    throw Error(ErrorCode::usage, "render",
                "the camera looks along its up vector or nowhere; give another --up or --target");
  return camera;
}

}  // namespace

int run(const RenderCommand& command, const Context& context) {
  check_output(command.output, picture_formats);
  const ShadedMesh mesh = load(command, context.common.orientation);
  const Picture picture =
      draw(mesh, choose_camera(mesh, command), command.options, context.progress);
  context.progress_ends();
  write_png(picture, command.output);
  if (!context.common.quiet) {
    fmt::print("exposure     {:.4g}\n", picture.exposure);
    fmt::print("wrote        {}\n", command.output.string());
  }
  return context.progress.stopped() ? exit_interrupted : exit_done;
}

}  // namespace halfshade
