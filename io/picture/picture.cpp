#include "io/picture/picture.h"

#include "io/picture/curve_overlay.h"
#include "io/picture/mesh_line.h"
#include "io/picture/seen_mesh.h"
#include "io/picture/tone_map.h"
#include "meshing/core/parallel.h"

#include <cmath>

namespace halfshade {
namespace {

/// The part of the headlight that comes from everywhere: surfaces seen edge-on do not turn black.
constexpr double from_everywhere = 0.25;

/// What a ray sees of the light.
Rgb seen_light(const ShadedMesh& mesh, const detail::SeenMesh& seen, const Hit& hit,
               const Vec3& ray) {
  const Rgb value = seen.value(hit);
  if (!mesh.headlight || seen.emits(hit)) return value;
  const double cosine = std::abs(seen.normal(hit).dot(ray.stableNormalized()));
  return value * (from_everywhere + (1 - from_everywhere) * cosine);
}

/// Chooses the exposure from rays on a grid over the picture.
double fitting_exposure(const ShadedMesh& mesh, const detail::SeenMesh& seen,
                        const Progress& progress) {
  const std::vector<Vec3> rays = survey(seen.view());
  std::vector<Rgb> values(rays.size(), Rgb::Zero());
  std::vector<double> weights(rays.size(), 0);
  std::vector<std::uint8_t> emits(rays.size(), 0);
  const auto look = [&](std::size_t i) {
    const auto hit = seen.cast(rays[i]);
    if (!hit) return;
    values[i] = seen_light(mesh, seen, *hit, rays[i]);
    weights[i] = 1;
    emits[i] = seen.emits(*hit);
  };
  parallel_for(rays.size(), look, Progress{progress.stop, {}});
  return choose_exposure(values, weights, emits);
}

}  // namespace

Picture draw(const ShadedMesh& mesh, const Camera& camera, const PictureOptions& options,
             const Progress& progress) {
  const detail::SeenMesh seen(mesh, detail::make_view(camera, options), options.shading);
  const double exposure =
      options.exposure > 0 ? options.exposure : fitting_exposure(mesh, seen, progress);
  const auto sample = [&](const Vec3& ray) -> Rgb {
    const auto hit = seen.cast(ray);
    if (!hit) return detail::background;
    const Rgb value = tone_map(seen_light(mesh, seen, *hit, ray), exposure);
    if (!options.mesh_lines || !seen.is_on_border(*hit, ray)) return value;
    return detail::with_mesh_line(value, tone_map(seen.triangle_value(*hit), exposure));
  };
  detail::LineCanvas canvas(options.width, options.height, Rgb::Zero());
  const auto look = [&](std::size_t pixel, std::span<const Vec3> rays) {
    Rgb sum = Rgb::Zero();
    for (const Vec3& ray : rays) sum += sample(ray);
    canvas.set(pixel, sum / static_cast<double>(rays.size()));
  };
  Picture picture{options.width, options.height, exposure, {}, {}};
  if (for_each_pixel(seen.view(), options.samples, look, progress))
    detail::overlay(canvas, options.curves, seen, options.curve_width);
  picture.pixels = canvas.bytes();
  return picture;
}

}  // namespace halfshade
