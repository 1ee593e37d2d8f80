#include "solver/reflected/probe_places.h"

#include "solver/reflected/ray_exchange.h"

#include <cmath>

namespace halfshade {
namespace {

TrianglePlace random_place(std::uint64_t seed) {
  const double across = std::sqrt(random_number(seed, 1)), along = random_number(seed, 2);
  return {across * (1 - along), across * along};
}

}  // namespace

std::vector<ProbePlace> spread_probes(const ReflectedMesh& mesh, const std::vector<double>& weight,
                                      int points, int use) {
  double roots = 0;
  for (int e = 0; e < mesh.count(); ++e) roots += std::sqrt(mesh.area(e));
  std::vector<ProbePlace> probes;
  for (int e = 0; e < mesh.count(); ++e) {
    const double wanted = points * std::sqrt(mesh.area(e)) / roots;
    // Numbers above those of nodes, and of several points apart.
    const std::uint64_t count_seed = ray_seed(mesh.triangle[at(e)], 63, 2 * use);
    const std::uint64_t place_seed = ray_seed(mesh.triangle[at(e)], 62, use);
    const int count = static_cast<int>(std::floor(wanted + random_number(count_seed, 0)));
    for (int k = 0; k < count; ++k) {
      const std::uint64_t seed = place_seed + static_cast<std::uint64_t>(k) * 0x1000003;
      probes.push_back({e, random_place(seed), mesh.area(e) / wanted, seed, weight[at(e)]});
    }
  }
  return probes;
}

}  // namespace halfshade
