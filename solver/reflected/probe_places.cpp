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

}  // namespace

std::vector<double> shares_of_probes(const ReflectedMesh& mesh,
                                     const std::vector<double>& expected) {
  // Of the mean: a sun or a plain would leave nothing to all others.
  constexpr double most = 20;
  std::vector<double> shares;
  for (int e = 0; e < mesh.count(); ++e) shares.push_back(std::sqrt(mesh.area(e)));
  const auto sum_of_counted = [&] {
    std::pair<double, int> sum = {0, 0};
    for (int e = 0; e < mesh.count(); ++e)
      if (mesh.counts(e)) sum.first += shares[at(e)], ++sum.second;
    return sum;
  };
  for (bool again = true; again;) {
    const auto [sum, count] = sum_of_counted();
    const double largest = most * sum / count;
    again = false;
    for (double& share : shares) {
      again = again || share > 2 * largest;
      share = std::min(share, largest);
    }
  }
  const double sum = sum_of_counted().first;
  double roots = 0;
  for (const double square : expected) roots += std::sqrt(square);
  for (std::size_t e = 0; e < shares.size(); ++e) {
    shares[e] /= sum;
    if (roots > 0) shares[e] = 0.5 * (shares[e] + std::sqrt(expected[e]) / roots);
  }
  return shares;
}

std::vector<ProbePlace> spread_probes(const ReflectedMesh& mesh, const std::vector<double>& weight,
                                      const std::vector<double>& shares, int points, int use) {
  std::vector<ProbePlace> probes;
  for (int e = 0; e < mesh.count(); ++e) {
    const double wanted = points * shares[at(e)];
    // Numbers above those of nodes, and of several points apart.
    const std::uint64_t count_seed = ray_seed(mesh, e, 63, 2 * use);
    const std::uint64_t place_seed = ray_seed(mesh, e, 62, use);
    const int count = static_cast<int>(std::floor(wanted + random_number(count_seed, 0)));
    for (int k = 0; k < count; ++k) {
      const std::uint64_t seed = place_seed + static_cast<std::uint64_t>(k) * 0x1000003;
      probes.push_back({e, random_place(seed), mesh.area(e) / wanted, seed, weight[at(e)]});
    }
  }
  return probes;
}

}  // namespace halfshade
