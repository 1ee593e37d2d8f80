#include "meshing/patches/curve_polylines.h"

#include "meshing/patches/margins.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

double factorial(int k) { return std::tgamma(k + 1.0); }

double largest_jump(const DiscontinuityCurve& curve) {
  double largest = 0;
  for (const double jump : curve.jump) largest = std::max(largest, std::abs(jump));
  return largest;
}

}  // namespace

bool is_negligible(const DiscontinuityCurve& curve, double h, double irradiance_tolerance) {
  return curve.order > 0 &&
         largest_jump(curve) * std::pow(h, curve.order) / factorial(curve.order) <
             irradiance_tolerance;
}

double flattening_deviation(const DiscontinuityCurve& curve, double surface_size,
                            const DiscontinuityMeshOptions& options) {
  if (options.deviation > 0) return options.deviation * surface_size;
  if (!(options.irradiance_tolerance > 0) || curve.order == 0)
    return margins::default_deviation * surface_size;
  // Without a jump infinite, and cut off below.
  const double harmless =
      std::pow(factorial(curve.order) * options.irradiance_tolerance / largest_jump(curve),
               1.0 / curve.order);
  const double most = margins::largest_deviation * element_size(surface_size, options.max_length);
  return std::min(most, std::max(harmless, margins::least_deviation * surface_size));
}

CurvePolylines curve_polylines(const SoundScene& scene, const Discontinuities& found,
                               const DiscontinuityMeshOptions& options) {
  CurvePolylines result;
  result.of_surface.resize(scene.surfaces.size());
  result.deviation.assign(scene.surfaces.size(), 0);
  std::vector<double> size;
  for (const Surface& surface : scene.surfaces) size.push_back(size_of(surface));
  for (std::size_t id = 0; id < found.curves.size(); ++id) {
    const DiscontinuityCurve& curve = found.curves[id];
    const auto r = at(curve.receiver);
    if (is_negligible(curve, element_size(size[r], options.max_length),
                      options.irradiance_tolerance)) {
      ++result.culled;
      continue;
    }
    ++result.kept;
    const double deviation = flattening_deviation(curve, size[r], options);
    if (!curve.arc.is_straight) result.deviation[r] = std::max(result.deviation[r], deviation);
    CurvePolyline& polyline = result.of_surface[r].emplace_back();
    polyline.id = static_cast<int>(id);
    for (const double s : flatten(curve.arc, deviation))
      polyline.points.push_back(point_at(curve.arc, s));
  }
  return result;
}

}  // namespace halfshade
