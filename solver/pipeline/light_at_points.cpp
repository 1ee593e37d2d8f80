#include "solver/pipeline/light_at_points.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "solver/elements/element_lookup.h"
#include "solver/pipeline/surface_finder.h"

#include <fmt/format.h>

namespace halfshade {
namespace {

PointLight light_at(const SolveResult& result, const ForestPlace& found) {
  const int e = found.triangle;
  if (result.direct.count() == 0)
    return {result.solution.irradiance.row(e).transpose(),
            result.solution.direct_irradiance.row(e).transpose()};
  return {value_at(result.irradiance, e, found.place), value_at(result.direct, e, found.place)};
}

}  // namespace

bool add_gathered_light(const SolveResult& result, double tolerance,
                        std::span<const FieldPoint> points, std::span<DirectLight> light,
                        const Progress& progress) {
  return !result.reflected_light ||
         add_gathered_light(*result.reflected_light, tolerance, points, light, progress);
}

bool add_gathered_light(const ReflectedLight& reflected, double tolerance,
                        std::span<const FieldPoint> points, std::span<DirectLight> light,
                        const Progress& progress) {
  const int rays = gathering_rays(tolerance);
  return parallel_for(
      points.size(),
      [&](std::size_t k) {
        if (reflected.report().through_operator) light[k].irradiance.setZero();
        const auto& [point, surface] = points[k];
        light[k].irradiance += surface < 0 ? reflected.gather(point, rays)
                                           : reflected.gather_on(surface, point.position, rays);
      },
      progress, "reflected light at points");
}

std::vector<PointLight> light_at_points(const SolveResult& result,
                                        std::span<const SurfacePoint> points) {
  const ElementLookup lookup(result.elements);
  const SurfaceFinder finder(result.scene);
  std::vector<PointLight> light;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3& p = points[k].position;
    const int surface = finder.at_point(points[k]);
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
