#include "apps/command_files.h"
#include "apps/console.h"
#include "apps/run_end.h"
#include "meshing/core/error.h"
#include "meshing/repair/repair.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

CommandFiles checked_files(const RenderCommand& command, const CommonOptions& common) {
  CommandFiles files = has_format(command.input, shaded_formats)
                           ? CommandFiles{{{"INPUT", command.input}}, {{"--json", common.json}}}
                           : scene_files(command.input, command.materials, common);
  add_outputs(files, "-o", {command.output});
  require_apart(files);
  require_place(common.json);
  check_output(command.output, picture_formats);
  return files;
}

/// Pictures of scenes do without contact lines where there are very many.
constexpr double most_contacts = 60000;

SoundScene sound_for_picture(const Scene& scene) {
  try {
    return make_sound(scene, {.most_contacts = most_contacts});
  } catch (const Error& error) {
    if (error.code() != ErrorCode::too_large) throw;
    return make_sound(scene, {.contacts = false});
  }
}

ShadedMesh load(const RenderCommand& command, const CommandFiles& files, const Context& context) {
  if (has_format(command.input, shaded_formats)) return read_shaded(command.input);
  const SceneFile file =
      read_scene(command.input, command.materials, context.common.orientation, files);
  ShadedMesh mesh = shaded(sound_for_picture(file.scene), file.scene.cameras);
  print_warnings(file, {}, context);
  return mesh;
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

ExitCode run(const RenderCommand& command, const Context& context) {
  const CommandFiles files = checked_files(command, context.common);
  const ShadedMesh mesh = load(command, files, context);
  const Camera camera = choose_camera(mesh, command);
  const Picture picture = draw(mesh, camera, command.options, context.progress);
  context.progress_ends();
  // A picture does not show what of it is missing.
  if (context.progress.stopped()) return end_without_results();
  write_png(picture, command.output);
  if (!context.common.json.empty())
    write_report(RenderReport{picture.width, picture.height, picture.exposure, camera},
                 run_info(context, exit_done, {command.output}), context.common.json);
  if (!context.common.quiet) {
    fmt::print(context.summary, "exposure     {:.4g}\n", picture.exposure);
    print_outputs(context, {command.output});
  }
  return exit_done;
}

}  // namespace halfshade
