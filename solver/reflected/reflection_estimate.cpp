#include "solver/reflected/reflection_estimate.h"

#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

struct Probe {
  int element;
  int number;    ///< in its element
  double share;  ///< of the area that it stands for
  double product = 0, square = 0;
};

/// The largest errors are those of small elements beside contacts: points as the square root of the
/// area, in the mean over `use`.
std::vector<Probe> spread_probes(const ReflectedMesh& mesh, const ReflectionProbes& options) {
  double roots = 0;
  for (int e = 0; e < mesh.count(); ++e) roots += std::sqrt(mesh.area(e));
  std::vector<Probe> probes;
  for (int e = 0; e < mesh.count(); ++e) {
    const double wanted = options.points * std::sqrt(mesh.area(e)) / roots;
    const std::uint64_t seed = ray_seed(mesh.triangle[at(e)], 63, 2 * options.use);
    const int count = static_cast<int>(std::floor(wanted + random_number(seed, 0)));
    for (int k = 0; k < count; ++k) probes.push_back({e, k, mesh.area(e) / wanted});
  }
  return probes;
}

TrianglePlace random_place(std::uint64_t seed) {
  const double across = std::sqrt(random_number(seed, 1)), along = random_number(seed, 2);
  return {across * (1 - along), across * along};
}

}  // namespace

ReflectionEstimate estimate_error(const ReflectingScene& scene, const ReflectedSystem& system,
                                  const SplitIrradiance& irradiance,
                                  const ReflectionProbes& options, const Progress& progress) {
  const auto& [mesh, light, exchange, systems] = system;
  const QuickField leaving(options.leaving);
  const QuickField rest(irradiance.rest);
  std::vector<Probe> probes = spread_probes(mesh, options);
  const int strata = std::max(3, static_cast<int>(std::lround(std::sqrt(options.rays / 2.))));
  ReflectionEstimate estimate;
  estimate.complete = parallel_for(
      probes.size(),
      [&](std::size_t i) {
        thread_local std::vector<RayEnd> ends;
        HemisphereRays caster(scene);
        Probe& probe = probes[i];
        const int e = probe.element;
        // Numbers above those of nodes, and of several points apart.
        const std::uint64_t seed = ray_seed(mesh.triangle[at(e)], 62, options.use) +
                                   static_cast<std::uint64_t>(probe.number) * 0x1000003;
        const TrianglePlace place = random_place(seed);
        const Rgb here = rest.value(e, place);
        Rgb product = Rgb::Ones();
        for (int h = 0; h < 2; ++h) {
          ends.clear();
          const int rays = caster.cast(ray_origin(scene, mesh, e, place), strata,
                                       mix_bits(seed + static_cast<std::uint64_t>(h)), ends);
          product *= gathered(light, mesh, leaving, ends, rays) - here;
        }
        probe.product = product.sum();
        const Rgb constant = irradiance.constant.row(systems.of_element[at(e)]).transpose();
        probe.square = (light.direct_at(mesh.root(e), mesh.position(e, place)) + here + constant)
                           .square()
                           .sum();
      },
      progress, "error of reflected light");
  estimate.square_error.assign(at(mesh.count()), 0);
  for (const Probe& probe : probes) {
    estimate.square_error[at(probe.element)] += probe.share * probe.product;
    estimate.sum += probe.share * probe.product;
    estimate.deviation += probe.share * probe.share * probe.product * probe.product;
    estimate.square_total += probe.share * probe.square;
  }
  estimate.deviation = std::sqrt(estimate.deviation);
  estimate.rays = probes.size() * 2 * at(strata) * at(strata);
  return estimate;
}

}  // namespace halfshade
