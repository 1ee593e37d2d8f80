#include "solver/reflected/exact_estimate.h"

#include "meshing/core/parallel.h"

#include <algorithm>
#include <span>

namespace halfshade {
namespace {

/// Places hardly see what single rows of nodes are off: all that may come from where they do not
/// know what they see is added. Elements without a place weigh as much as any.
void add_unsure(const ReflectedMesh& mesh, const IrradianceOperator& exchange, const Rgb& brightest,
                std::span<const ProbePlace> probes, ReflectionEstimate& estimate) {
  double most = 0;
  for (const ProbePlace& probe : probes) most = std::max(most, probe.weight);
  std::vector<double> weight(at(mesh.count()), most);
  for (const ProbePlace& probe : probes) weight[at(probe.element)] = probe.weight;
  for (int e = 0; e < mesh.count(); ++e) {
    const double unsure = exchange.unsure(e);
    if (!(unsure > 0)) continue;
    const double square = weight[at(e)] * mesh.area(e) * (unsure * brightest).square().sum();
    estimate.square_error[at(e)] += square;
    estimate.sum += square;
    estimate.chance[at(e)] = 1;
  }
}

}  // namespace

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
        probe.square_error =
            probe.missing.square().sum() + (found.unsure * gather.brightest()).square().sum();
        const Rgb constant = irradiance.constant.row(systems.of_element[at(e)]).transpose();
        probe.square = light.square_beside_known(light.direct_at(root, position), here + constant);
      },
      progress, "error of reflected light");
  estimate.add(mesh, probes, light.direct_square.value_or(0));
  add_unsure(mesh, exchange, gather.brightest(), probes, estimate);
  return estimate;
}

}  // namespace halfshade
