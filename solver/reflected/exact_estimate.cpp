#include "solver/reflected/exact_estimate.h"

#include "meshing/core/parallel.h"

namespace halfshade {

ReflectionEstimate estimate_exactly(const ExactSight& sight, const ExactGather& gather,
                                    const ReflectedSystem& system,
                                    const SplitIrradiance& irradiance,
                                    std::vector<ProbePlace> probes, const Progress& progress) {
  const auto& [mesh, light, exchange, systems] = system;
  const QuickField rest(irradiance.rest);
  ReflectionEstimate estimate;
  estimate.complete = parallel_for(
      probes.size(),
      [&](std::size_t i) {
        ProbePlace& probe = probes[i];
        const int e = probe.element, root = mesh.root(e);
        const Vec3 position = mesh.position(e, probe.place);
        const std::vector<Sighted> targets =
            sight.may_see(mesh.forest.corners(mesh.triangle[at(e)]), root);
        const Rgb here = rest.value(e, probe.place);
        const ExactGather::Gathered found = gather.gather(root, position, targets);
        probe.missing = found.irradiance - here;
        probe.reach = found.reach;
        probe.square_error = probe.missing.square().sum();
        const Rgb constant = irradiance.constant.row(systems.of_element[at(e)]).transpose();
        probe.square = (light.direct_at(root, position) + here + constant).square().sum();
      },
      progress, "error of reflected light");
  estimate.add(mesh, probes);
  return estimate;
}

}  // namespace halfshade
