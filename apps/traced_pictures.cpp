#include "apps/traced_pictures.h"

#include "io/picture/seen_mesh.h"
#include "meshing/core/error.h"
#include "solver/reference/reference_picture.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

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

CameraRays camera_rays(const detail::View& view, const RenderCommand& command) {
  CameraRays rays{view.origin, view.corner, view.right, view.down, view.width, view.height};
  if (command.lens > 0) {
    rays.lens = command.lens;
    rays.focus = command.focus;
  }
  if (command.move) rays.move = *command.move;
  return rays;
}

/// A direction about the mirrored one, as dense as the lobe's cosine to the power of `exponent`.
Vec3 in_lobe(const Vec3& direction, const Vec3& normal, double exponent, const Vec2& numbers) {
  const PlaneFrame frame = make_frame(Vec3::Zero(), direction - 2 * direction.dot(normal) * normal);
  const double cosine = std::pow(1 - numbers.x(), 1 / (exponent + 1));
  const double sine = std::sqrt(1 - cosine * cosine), angle = 2 * std::numbers::pi * numbers.y();
  return sine * (std::cos(angle) * frame.e1 + std::sin(angle) * frame.e2) + cosine * frame.normal;
}

TracedRendering finished(TracedPicture traced, const Camera& camera) {
  TracedRendering result;
  result.report = {traced.width, traced.height, 0, camera, {}, {}, {}};
  result.report.samples = traced.samples;
  result.report.standard_error = traced.relative_error();
  result.radiance = {traced.width, traced.height, std::move(traced.radiance)};
  result.emits = std::move(traced.emits);
  return result;
}

}  // namespace

TracedRendering render_traced(const SoundScene& scene, const std::vector<Camera>& cameras,
                              const RenderCommand& command, const Progress& progress) {
  const Camera camera = chosen_camera(shaded(scene, cameras), command);
  const CameraRays rays = camera_rays(detail::make_view(camera, command.options), command);
  const PixelOptions pixels{.samples = command.options.samples};
  if (command.method == RenderMethod::reference)
    return finished(reference_picture(scene, rays, pixels, progress), camera);
  ClassicOptions classic = command.classic;
  classic.mirrors = mirrors(scene, command.mirrors);
  return finished(classic_picture(scene, rays, classic, pixels, progress), camera);
}

TracedRendering render_distributed(const ShadedMesh& mesh, const RenderCommand& command,
                                   const Progress& progress) {
  const Camera camera = chosen_camera(mesh, command);
  const detail::SeenMesh seen(mesh, detail::make_view(camera, command.options),
                              command.options.shading);
  const auto radiance = [&](const Hit& hit) -> Rgb {
    return seen.value(hit).max(0.) / std::numbers::pi;
  };
  const Look look = [&](const Vec3& origin, const Vec3& direction,
                        const SampleNumbers& numbers) -> SeenLight {
    const auto hit = seen.cast(origin, direction);
    if (!hit) return {};
    SeenLight light{radiance(*hit), seen.emits(*hit)};
    if (!(command.gloss > 0) || light.emits) return light;
    const Vec3 normal = seen.normal(*hit);
    const Vec3 on = in_lobe(direction, normal, command.classic.exponent, numbers.pair(0));
    if (!(on.dot(normal) > 0)) return light;
    const auto mirrored = seen.cast(origin + hit->distance * direction, on);
    if (mirrored) light.radiance += command.gloss * radiance(*mirrored);
    return light;
  };
  const PixelOptions pixels{.samples = command.options.samples};
  return finished(trace_pixels(camera_rays(seen.view(), command), pixels, look, progress), camera);
}

}  // namespace halfshade
