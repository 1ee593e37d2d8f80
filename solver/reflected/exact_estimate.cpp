#include "solver/reflected/exact_estimate.h"

#include "meshing/core/parallel.h"
#include "solver/reflected/direct_projection.h"
#include "solver/reflected/exact_exchange.h"
#include "solver/reflected/forest_field.h"
#include "solver/reflected/probe_places.h"

#include <cmath>

namespace halfshade {

ReflectionEstimate estimate_exactly(const ExactProbes& exact, const ReflectedSystem& system,
                                    const SplitIrradiance& irradiance,
                                    const ReflectionProbes& options, const Progress& progress) {
  const auto& [mesh, light, exchange, systems] = system;
  const ReflectedMesh fine = bisected(mesh, 2);
  DirectProjection direct(exact.direct_points);
  direct.update(fine, light);
  ElementField leaving = restricted(mesh, options.leaving, fine);
  leaving.coefficients += direct.leaving(fine, light).coefficients;
  const QuickField quick(forest_field(fine, leaving));
  const QuickField rest(irradiance.rest);
  const RowMaker maker(exact.sight, fine, exact.accuracy);

  std::vector<ProbePlace> probes = spread_probes(mesh, options.points, options.use);
  ReflectionEstimate estimate;
  estimate.complete = parallel_for(
      probes.size(),
      [&](std::size_t i) {
        ProbePlace& probe = probes[i];
        const int e = probe.element, root = mesh.root(e);
        const Vec3 position = mesh.position(e, probe.place);
        const std::vector<Sighted> targets =
            exact.sight.may_see(mesh.forest.corners(mesh.triangle[at(e)]), root);
        const IrradianceRow row = closed_row(maker, exact.scene, root, position, targets);
        const Rgb here = rest.value(e, probe.place);
        probe.square_error = (halfshade::irradiance(row, quick) - here).square().sum();
        const Rgb constant = irradiance.constant.row(systems.of_element[at(e)]).transpose();
        probe.square = (light.direct_at(root, position) + here + constant).square().sum();
      },
      progress, "error of reflected light");
  estimate.add(mesh, probes);
  return estimate;
}

}  // namespace halfshade
