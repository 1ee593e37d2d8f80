#include "solver/reflected/final_pass.h"

#include "meshing/core/parallel.h"
#include "solver/reflected/ray_exchange.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Rays from a node are two halves that tell the noise; each has at least this many squared.
constexpr int fewest_strata = 4;
constexpr double fewest = 16;
/// Of the noise, for that of each element is not known well.
constexpr double share_alike = 0.25;
/// Fewer more than this share of those that there are already do not pay.
constexpr double least_more = 0.25;

}  // namespace

FinalPass final_pass(const ReflectingScene& scene, const ReflectedMesh& mesh,
                     const FirstLight& light, const ElementField& leaving,
                     const std::vector<int>& strata, int use, const Progress& progress) {
  const LeavingField field(mesh, leaving);
  FinalPass result;
  result.rest = zero_field(mesh);
  result.noise.resize(at(mesh.count()));
  result.complete = parallel_for(
      at(mesh.count()),
      [&](std::size_t e) {
        const int element = static_cast<int>(e);
        const ElementNodes& nodes = element_nodes_of(result.rest.order[e]);
        if (strata[e] == 0) return;
        const ChannelArray halves = gathered(
            gather_rays(scene, light, Looks::quick,
                        halves_of_nodes(scene, mesh, element, strata[e], {2 * use, 2 * use + 1})),
            mesh.forest, field);
        result.rest.of(element) = (nodes.fit * means_of_halves(halves).matrix()).array();
        result.noise[e] = noise_of_halves(nodes, mesh.area(element), halves);
      },
      progress, "final rays of reflected light");
  for (int e = 0; e < mesh.count(); ++e)
    result.rays += 2 * rays_of_hemisphere(light, strata[at(e)]) *
                   element_nodes_of(result.rest.order[at(e)]).places.size();
  return result;
}

std::vector<int> share_rays(const ReflectedMesh& mesh, const std::vector<double>& noise,
                            const std::vector<double>& weight, const RayShares& shares) {
  double sum = 0, area = 0;
  for (int e = 0; e < mesh.count(); ++e) {
    sum += noise[at(e)];
    area += mesh.counts(e) ? weight[at(e)] * mesh.area(e) : 0;
  }
  std::vector<double> expected, rays;
  double sum_of_rays = 0, count = 0;  // of those that count: others change nothing for them
  for (int e = 0; e < mesh.count(); ++e) {
    const double alike = area > 0 && mesh.counts(e) ? sum / area * weight[at(e)] * mesh.area(e) : 0;
    const auto nodes =
        static_cast<double>(element_nodes_of(mesh.order[at(mesh.triangle[at(e)])]).places.size());
    expected.push_back((1 - share_alike) * noise[at(e)] + share_alike * alike);
    rays.push_back(std::sqrt(expected.back() / nodes));
    sum_of_rays += mesh.counts(e) ? rays.back() : 0;
    count += mesh.counts(e) ? 1 : 0;
  }
  for (double& r : rays) r = sum_of_rays > 0 ? r * count / sum_of_rays : 0;
  constexpr double step = 1.0625;
  double all = fewest;
  const auto missing = [&](std::size_t e) {
    const double more = rays_missing(all * rays[e], shares.sent[e]);
    return more > least_more * shares.sent[e] ? more : 0;
  };
  const auto is_noisy = [&] {
    double then = 0;
    for (std::size_t e = 0; e < rays.size(); ++e)
      then += expected[e] *
              std::pow(shares.rays / rays_as_good_as(shares.sent[e], missing(e)), noise_exponent);
    return then > shares.wanted;
  };
  while (all < shares.most && is_noisy()) all *= step;
  all = std::min(all, shares.most);
  std::vector<int> strata;
  for (std::size_t e = 0; e < rays.size(); ++e) {
    const int wanted = static_cast<int>(std::lround(std::sqrt(0.5 * missing(e))));
    strata.push_back(wanted > 0 ? std::max(fewest_strata, wanted) : 0);
  }
  return strata;
}

void conserve_power(const ReflectedMesh& mesh, const LightSystems& systems,
                    const ElementField& leaving, const ChannelArray& power,
                    SplitIrradiance& irradiance) {
  const ChannelArray wanted = power + integrals(mesh, systems, leaving);
  const ChannelArray found = integrals(mesh, systems, irradiance.rest);
  const ChannelArray all = irradiance.constant.colwise() * systems.area + found;
  ChannelArray gain = (all > 0).select((wanted - found) / all, 0.);
  for (int s = 0; s < systems.count(); ++s)
    if (!systems.closed[at(s)]) gain.row(s).setZero();
  for (int e = 0; e < mesh.count(); ++e)
    irradiance.rest.of(e).rowwise() *= 1 + gain.row(systems.of_element[at(e)]);
  add_constants(mesh, systems, gain * irradiance.constant, irradiance.rest);
}

void reflect_change(const ReflectedSystem& system, const ElementField& before,
                    const ElementField& ambient, SplitIrradiance& irradiance) {
  constexpr double tolerance = 1e-3;  // of a change that is small
  const auto& [mesh, light, exchange, systems] = system;
  ElementField change = irradiance.rest;
  change.coefficients -= before.coefficients;
  for (int e = 0; e < change.count(); ++e)
    change.of(e).bottomRows(change.of(e).rows() - 1).setZero();
  const ChannelArray power = -absorbed_integrals(mesh, light, systems, change);
  const ElementField arriving = exchange.apply(mesh, reflected_part(mesh, light, change));
  const ReflectedSolution more = solve_reflected(system, arriving, power, tolerance, &ambient);
  irradiance.constant += more.irradiance.constant;
  irradiance.rest.coefficients += more.irradiance.rest.coefficients;
}

}  // namespace halfshade
