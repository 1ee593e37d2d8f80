#include "solver/reflected/ray_passes.h"

#include <algorithm>

namespace halfshade {
namespace {

constexpr double share_of_all = 0.95, uncertain = 1.1;
/// A pass takes at least so much of the noise away that this share is left.
constexpr double least_gain = 0.75;

}  // namespace

double noise_after_pass(const ReflectionEstimate& estimate, double noise, double goal,
                        double enough) {
  const double of_elements = std::max(estimate.sum - noise, 0.);
  const double doubt = 2 * estimate.deviation / std::max(estimate.sum, noise);
  const double allowed =
      std::max(share_of_all / (1 + doubt) * goal - of_elements, least_noise * goal) / uncertain;
  return std::min(std::max(allowed, enough), least_gain * noise);
}

const RayPasses::OfTriangle* RayPasses::find(const ReflectedMesh& mesh, int element) const {
  const int t = mesh.triangle[at(element)];
  if (at(t) >= of_triangle_.size()) return nullptr;
  const OfTriangle& found = of_triangle_[at(t)];
  return found.more.rows() == basis_size(mesh.order[at(t)]) ? &found : nullptr;
}

std::vector<double> RayPasses::sent(const ReflectedMesh& mesh, std::vector<double> kept) const {
  for (int e = 0; e < mesh.count(); ++e)
    if (const OfTriangle* found = find(mesh, e))
      kept[at(e)] = rays_as_good_as(kept[at(e)], found->rays);
  return kept;
}

void RayPasses::correct(const ReflectedMesh& mesh, ElementField& rest, FieldNoise& noise) const {
  for (int e = 0; e < mesh.count(); ++e)
    if (const OfTriangle* found = find(mesh, e)) {
      rest.of(e) += found->more;
      noise[at(e)] = found->noise;
    }
}

void RayPasses::add(const ReflectedMesh& mesh, const FinalPass& pass,
                    const std::vector<int>& strata, const std::vector<double>& weight,
                    const ElementField& kept, const FieldNoise& noise) {
  of_triangle_.resize(at(mesh.forest.count()));
  // Number of passes before → noise.
  std::vector<double> before, now;
  const std::vector<double> of_kept = noise_of_elements(noise, weight);
  const std::vector<double> of_pass = noise_of_elements(pass.noise, weight);
  for (int e = 0; e < mesh.count(); ++e) {
    if (strata[at(e)] == 0) continue;
    OfTriangle& found = of_triangle_[at(mesh.triangle[at(e)])];
    if (!find(mesh, e)) {
      found = {};
      found.more = ChannelArray::Zero(kept.of(e).rows(), 3);
      found.noise = noise[at(e)];
    }
    before.resize(std::max(before.size(), at(found.passes) + 1), 0);
    now.resize(before.size(), 0);
    before[at(found.passes)] +=
        found.passes == 0 ? of_kept[at(e)] : noise_of_elements({found.noise}, {weight[at(e)]})[0];
    now[at(found.passes)] += of_pass[at(e)];
  }
  for (int e = 0; e < mesh.count(); ++e) {
    if (strata[at(e)] == 0) continue;
    OfTriangle& found = of_triangle_[at(mesh.triangle[at(e)])];
    const double old = before[at(found.passes)];
    const double share = old > 0 ? old / (old + now[at(found.passes)]) : 1;
    found.more = (1 - share) * found.more + share * (pass.rest.of(e) - kept.of(e));
    found.noise = mean_noise(found.noise, pass.noise[at(e)], share);
    found.rays = rays_as_good_as(found.rays, 2. * strata[at(e)] * strata[at(e)]);
    ++found.passes;
  }
  ++count_;
}

}  // namespace halfshade
