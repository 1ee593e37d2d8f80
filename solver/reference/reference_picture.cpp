#include "solver/reference/reference_picture.h"

#include "solver/reference/light_paths.h"

#include <numbers>

namespace halfshade {

TracedPicture reference_picture(const SoundScene& scene, const CameraRays& camera,
                                const PixelOptions& options, const Progress& progress) {
  const LightPaths paths(scene);
  return trace_pixels(
      camera, options,
      [&](const Vec3& origin, const Vec3& direction, const SampleNumbers& numbers) -> SeenLight {
        const auto seen = paths.seen(origin, direction);
        if (!seen) return {};
        const Surface& surface = scene.surfaces[at(seen->surface)];
        const Rgb& exitance = scene.materials[at(surface.material)].exitance;
        const Rgb rho = reflectance_at(scene, surface, seen->point.position);
        Rgb radiosity = exitance;
        if ((rho > 0).any()) radiosity += rho * paths.trace(seen->point, -1, numbers).total;
        return {radiosity / std::numbers::pi, (exitance > 0).any()};
      },
      progress);
}

}  // namespace halfshade
