#include "solver/reflected/reflection_estimate.h"

#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <cmath>

namespace halfshade {

void ReflectionEstimate::add(const ReflectedMesh& mesh, std::span<const ProbePlace> probes) {
  square_error.resize(at(mesh.count()), 0);
  double variance = deviation * deviation;
  for (const ProbePlace& probe : probes) {
    const double error = probe.share * probe.weight * probe.square_error;
    square_error[at(probe.element)] += error;
    sum += error;
    variance += error * error;
    square_total += probe.share * probe.square;
  }
  deviation = std::sqrt(variance);
}

ReflectionEstimate estimate_error(const ReflectingScene& scene, const ReflectedSystem& system,
                                  const SplitIrradiance& irradiance,
                                  const ReflectionProbes& options, const Progress& progress) {
  const auto& [mesh, light, exchange, systems] = system;
  const QuickField leaving(options.leaving);
  const QuickField rest(irradiance.rest);
  std::vector<ProbePlace> probes = spread_probes(mesh, options.weight, options.points, options.use);
  const int strata = std::max(3, static_cast<int>(std::lround(std::sqrt(options.rays / 2.))));
  ReflectionEstimate estimate;
  estimate.complete = parallel_for(
      probes.size(),
      [&](std::size_t i) {
        thread_local std::vector<RayEnd> ends;
        HemisphereRays caster(scene);
        ProbePlace& probe = probes[i];
        const int e = probe.element;
        const TrianglePlace& place = probe.place;
        const Rgb here = rest.value(e, place);
        Rgb product = Rgb::Ones();
        for (int h = 0; h < 2; ++h) {
          ends.clear();
          const int rays = caster.cast(ray_origin(scene, mesh, e, place), strata,
                                       mix_bits(probe.seed + static_cast<std::uint64_t>(h)), ends);
          product *= gathered(light, mesh, leaving, ends, rays) - here;
        }
        probe.square_error = product.sum();
        const Rgb constant = irradiance.constant.row(systems.of_element[at(e)]).transpose();
        probe.square = (light.direct_at(mesh.root(e), mesh.position(e, place)) + here + constant)
                           .square()
                           .sum();
      },
      progress, "error of reflected light");
  estimate.add(mesh, probes);
  estimate.rays = probes.size() * 2 * at(strata) * at(strata);
  return estimate;
}

}  // namespace halfshade
