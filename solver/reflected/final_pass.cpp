#include "solver/reflected/final_pass.h"

#include "meshing/core/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace halfshade {
namespace {

/// Rays from a node are two halves that tell the noise; each has at least this many squared.
constexpr int fewest_strata = 4;

struct ElementPass {
  const ReflectingScene& scene;
  const ReflectedMesh& mesh;
  const FirstLight& light;
  const QuickField leaving;
  int use;

  /// The coefficients; adds to the noise.
  Eigen::MatrixXd operator()(int element, int strata, double& noise) const {
    thread_local std::vector<RayEnd> ends;
    HemisphereRays caster(scene);
    const int triangle = mesh.triangle[at(element)];
    const ElementNodes& nodes = element_nodes_of(mesh.order[at(triangle)]);
    Eigen::MatrixXd values(static_cast<Eigen::Index>(nodes.places.size()), 3);
    for (std::size_t k = 0; k < nodes.places.size(); ++k) {
      const RayOrigin from = ray_origin(scene, mesh, element, nodes.places[k]);
      std::array<Rgb, 2> half;
      for (int h = 0; h < 2; ++h) {
        ends.clear();
        const std::uint64_t seed = ray_seed(triangle, static_cast<int>(k), 2 * use + h);
        const int rays = caster.cast(from, strata, seed, ends);
        half[at(h)] = gathered(light, mesh, leaving, ends, rays);
      }
      const auto row = static_cast<Eigen::Index>(k);
      values.row(row) = (0.5 * (half[0] + half[1])).transpose();
      noise += nodes.spread[row] * 0.25 * (half[0] - half[1]).square().sum();
    }
    noise *= mesh.area(element);
    return nodes.fit * values;
  }
};

/// Noise of small elements counts less: rays as the square root of the area.
std::vector<int> strata_of(const ReflectedMesh& mesh, int rays) {
  double mean = 0;
  for (int e = 0; e < mesh.count(); ++e) mean += std::sqrt(mesh.area(e)) / mesh.count();
  std::vector<int> strata;
  for (int e = 0; e < mesh.count(); ++e) {
    const double wanted = 0.5 * rays * std::sqrt(mesh.area(e)) / mean;
    strata.push_back(std::max(fewest_strata, static_cast<int>(std::lround(std::sqrt(wanted)))));
  }
  return strata;
}

}  // namespace

FinalPass final_pass(const ReflectingScene& scene, const ReflectedMesh& mesh,
                     const FirstLight& light, const ElementField& leaving,
                     const FinalPassOptions& options, const Progress& progress) {
  const std::vector<int> strata = strata_of(mesh, options.rays);
  const ElementPass pass{scene, mesh, light, QuickField(leaving), options.use};
  FinalPass result;
  result.rest = zero_field(mesh);
  result.noise.assign(at(mesh.count()), 0);
  result.complete = parallel_for(
      at(mesh.count()),
      [&](std::size_t e) {
        const int element = static_cast<int>(e);
        result.rest.of(element) = pass(element, strata[e], result.noise[e]).array();
      },
      progress, "final rays of reflected light");
  for (int e = 0; e < mesh.count(); ++e)
    result.rays += 2 * at(strata[at(e)]) * at(strata[at(e)]) *
                   element_nodes_of(result.rest.order[at(e)]).places.size();
  return result;
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
  add_constants(mesh, systems, gain * irradiance.constant, nullptr, irradiance.rest);
}

}  // namespace halfshade
