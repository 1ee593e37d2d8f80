#include "solver/reflected/probe_places.h"

#include "solver/reflected/ray_exchange.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

TrianglePlace random_place(std::uint64_t seed) {
  const double across = std::sqrt(random_number(seed, 1)), along = random_number(seed, 2);
  return {across * (1 - along), across * along};
}

/// What the numbers of probes in elements are as: the roots of their areas, but none more than so
/// many times their mean. A sun or a plain would leave nothing to all others.
std::vector<double> shares_of_probes(const ReflectedMesh& mesh) {
  constexpr double most = 20;
  std::vector<double> shares;
  for (int e = 0; e < mesh.count(); ++e) shares.push_back(std::sqrt(mesh.area(e)));
  for (bool again = true; again;) {
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.);
    const double largest = most * sum / static_cast<double>(shares.size());
    again = false;
    for (double& share : shares) {
      again = again || share > 2 * largest;
      share = std::min(share, largest);
    }
  }
  return shares;
}

}  // namespace

std::vector<ProbePlace> spread_probes(const ReflectedMesh& mesh, const std::vector<double>& weight,
                                      int points, int use) {
  const std::vector<double> shares = shares_of_probes(mesh);
  const double all = std::accumulate(shares.begin(), shares.end(), 0.);
  std::vector<ProbePlace> probes;
  for (int e = 0; e < mesh.count(); ++e) {
    const double wanted = points * shares[at(e)] / all;
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
