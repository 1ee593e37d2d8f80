#include "apps/traced_pictures.h"

#include "io/picture/view.h"
#include "meshing/core/error.h"
#include "solver/reference/reference_picture.h"

#include <fmt/format.h>

namespace halfshade {
namespace {

/// Surfaces of groups or materials of these names.
std::vector<bool> mirrors(const SoundScene& scene, const std::vector<std::string>& names) {
  std::vector<bool> found(scene.surfaces.size());
  for (const std::string& name : names) {
    bool is_there = false;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
      if (scene.groups[at(scene.surfaces[s].group)] == name ||
          scene.materials[at(scene.surfaces[s].material)].name == name)
        found[s] = is_there = true;
    if (!is_there)
      throw Error(ErrorCode::usage, "--mirror",
                  fmt::format("there is neither a group nor a material '{}'", name));
  }
  return found;
}

CameraRays camera_rays(const Camera& camera, const PictureOptions& options) {
  const detail::View view = detail::make_view(camera, options);
  return {view.origin, view.corner, view.right, view.down, view.width, view.height};
}

}  // namespace

TracedRendering render_traced(const SoundScene& scene, const std::vector<Camera>& cameras,
                              const RenderCommand& command, const Progress& progress) {
  const Camera camera = chosen_camera(shaded(scene, cameras), command);
  const CameraRays rays = camera_rays(camera, command.options);
  const PixelOptions pixels{.samples = command.options.samples};
  TracedPicture traced;
  if (command.method == RenderMethod::reference) {
    traced = reference_picture(scene, rays, pixels, progress);
  } else {
    ClassicOptions classic = command.classic;
    classic.mirrors = mirrors(scene, command.mirrors);
    traced = classic_picture(scene, rays, classic, pixels, progress);
  }
  TracedRendering result;
  result.report = {traced.width, traced.height, 0, camera, {}, {}, {}};
  result.report.samples = traced.samples;
  result.report.standard_error = traced.relative_error();
  result.radiance = {traced.width, traced.height, std::move(traced.radiance)};
  result.emits = std::move(traced.emits);
  return result;
}

}  // namespace halfshade
