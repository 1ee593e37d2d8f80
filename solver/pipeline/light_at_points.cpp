#include "solver/pipeline/light_at_points.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/core/planar.h"
#include "solver/elements/element_lookup.h"

#include <fmt/format.h>

#include <cmath>

namespace halfshade {
namespace {

/// How far a point may be from a surface, as a share of the surface's size, and how far its normal
/// may be turned from the surface's, in radians: what six digits of a table leave.
constexpr double off_surface = 1e-6, turned = 1e-3;

/// −1 if the point lies on none.
int surface_at(const SoundScene& scene, const SurfacePoint& point) {
  int nearest = -1;
  double least = 0;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    if ((surface.frame.normal - point.normal).norm() > turned) continue;
    const double size = size_of(surface), height = surface.frame.height(point.position);
    if (std::abs(height) > off_surface * size) continue;
    const Vec2 q = surface.frame.to_plane(point.position);
    const double beside = is_inside(surface.rings, q) ? 0 : distance_to_rings(surface.rings, q);
    const double off = std::hypot(height, beside);
    if (beside > off_surface * size || (nearest >= 0 && off >= least)) continue;
    nearest = static_cast<int>(s);
    least = off;
  }
  return nearest;
}

PointLight light_at(const SolveResult& result, const ForestPlace& found) {
  const int e = found.triangle;
  if (result.direct.count() == 0)
    return {result.solution.irradiance.row(e).transpose(),
            result.solution.direct_irradiance.row(e).transpose()};
  return {value_at(result.irradiance, e, found.place), value_at(result.direct, e, found.place)};
}

}  // namespace

bool add_gathered_light(const SolveResult& result, double tolerance,
                        std::span<const SurfacePoint> points, std::span<DirectLight> light,
                        const Progress& progress) {
  return !result.reflected_light ||
         add_gathered_light(*result.reflected_light, tolerance, points, light, progress);
}

bool add_gathered_light(const ReflectedLight& reflected, double tolerance,
                        std::span<const SurfacePoint> points, std::span<DirectLight> light,
                        const Progress& progress) {
  const int rays = gathering_rays(tolerance);
  return parallel_for(
      points.size(),
      [&](std::size_t k) {
        if (reflected.report().through_operator) light[k].irradiance.setZero();
        light[k].irradiance += reflected.gather(points[k], rays);
      },
      progress, "reflected light at points");
}

std::vector<PointLight> light_at_points(const SolveResult& result,
                                        std::span<const SurfacePoint> points) {
  const ElementLookup lookup(result.elements);
  std::vector<PointLight> light;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3& p = points[k].position;
    const int surface = surface_at(result.scene, points[k]);
    const ForestPlace found = surface < 0 ? ForestPlace{} : lookup.find(surface, p);
    if (found.triangle < 0)
      throw Error(ErrorCode::invalid_input, {},
                  fmt::format("point {} ({}, {}, {}) lies on no surface with its normal", k + 1,
                              p.x(), p.y(), p.z()));
    light.push_back(light_at(result, found));
  }
  return light;
}

}  // namespace halfshade
