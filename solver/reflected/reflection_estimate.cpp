#include "solver/reflected/reflection_estimate.h"

#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/reflected/field_noise.h"
#include "solver/reflected/gathering.h"
#include "solver/reflected/leaving_field.h"
#include "solver/reflected/quick_field.h"
#include "solver/reflected/ray_exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace halfshade {

void ReflectionEstimate::add(const ReflectedMesh& mesh, std::span<const ProbePlace> probes,
                             double known_square) {
  square_error.resize(at(mesh.count()), 0);
  chance.resize(at(mesh.count()), 0);
  std::array<Rgb, parts_of_probes> none;
  none.fill(Rgb::Zero());
  missing.resize(at(mesh.count()), none);
  reach.resize(at(mesh.count()), 0);
  probed.resize(at(mesh.count()), 0);
  std::size_t part = 0;  // those of an element follow each other
  double variance = deviation * deviation;
  square_total += known_square;
  for (const ProbePlace& probe : probes) {
    const double error = probe.share * probe.weight * probe.square_error;
    square_error[at(probe.element)] += error;
    missing[at(probe.element)][part] += parts_of_probes * probe.share * probe.reach * probe.missing;
    part = (part + 1) % parts_of_probes;
    reach[at(probe.element)] += probe.share * probe.reach;
    probed[at(probe.element)] += probe.share;
    chance[at(probe.element)] = std::min(mesh.area(probe.element) / probe.share, 1.);
    sum += error;
    variance += error * error;
    square_total += probe.share * probe.square;
  }
  deviation = std::sqrt(variance);
}

void ReflectionEstimate::join(const ReflectionEstimate& other, double weight_of_other) {
  const double a = 1 - weight_of_other, b = weight_of_other;
  for (std::size_t e = 0; e < square_error.size(); ++e) {
    square_error[e] = a * square_error[e] + b * other.square_error[e];
    for (std::size_t p = 0; p < parts_of_probes; ++p)
      missing[e][p] = a * missing[e][p] + b * other.missing[e][p];
    reach[e] = a * reach[e] + b * other.reach[e];
    probed[e] = a * probed[e] + b * other.probed[e];
    // Of points of both: what one says of it, for the other may have missed it.
    chance[e] = std::min(std::max(chance[e] / a, other.chance[e] / b), 1.);
  }
  sum = a * sum + b * other.sum;
  deviation = std::hypot(a * deviation, b * other.deviation);
  square_total = a * square_total + b * other.square_total;
  rays += other.rays;
  complete = complete && other.complete;
}

double rough_square(const ReflectedSystem& system, const SplitIrradiance& irradiance,
                    const DirectProjection* direct) {
  const ReflectedMesh& mesh = system.mesh;
  const ElementField whole = irradiance.whole(mesh, system.systems);
  double sum = 0;
  for (int e = 0; e < whole.count(); ++e) {
    Rgb mean = whole.of(e).row(0).transpose();
    if (direct != nullptr) mean += direct->mean(mesh, e);
    sum += mesh.area(e) * mean.square().sum();
  }
  return sum;
}

std::vector<int> share_probe_rays(const ReflectedMesh& mesh, const std::vector<double>& noise,
                                  const std::vector<double>& shares, double known, double allowed) {
  constexpr double fewest = 4, most = 48, fewest_in_mean = 25;  // strata, strata, rays
  double all = 0, area = 0, mean = 0;
  for (int e = 0; e < mesh.count(); ++e) {
    all += noise[at(e)];
    area += mesh.counts(e) ? mesh.area(e) : 0;
  }
  std::vector<double> part;  // of the noise of the estimate, if all had as many rays
  for (int e = 0; e < mesh.count(); ++e) {
    const double even = all * std::min(mesh.area(e) / area, 1.);
    part.push_back((noise[at(e)] + even) / shares[at(e)]);
    if (mesh.counts(e)) mean += shares[at(e)] * part.back();
  }
  const double too_much = allowed > 0 ? all / allowed : 0;
  const double rays = std::max(known * std::pow(too_much, 1 / noise_exponent), fewest_in_mean);
  std::vector<int> strata;
  for (const double x : part) {
    const double wanted = mean > 0 ? rays * std::pow(x / mean, 2. / 3) : rays;
    strata.push_back(static_cast<int>(std::lround(std::clamp(std::sqrt(wanted), fewest, most))));
  }
  return strata;
}

namespace {

double share_that_ends(const TracedHemispheres& traced) {
  double ends = 0, rays = 0;
  for (const HemisphereEnds& each : traced.of_each) {
    ends += each.last - each.first;
    rays += each.rays;
  }
  return rays > 0 ? ends / rays : 0;
}

}  // namespace

ReflectionEstimate estimate_error(const ReflectingScene& scene, const ReflectedSystem& system,
                                  const SplitIrradiance& irradiance,
                                  const ReflectionProbes& options, const Progress& progress) {
  const auto& [mesh, light, exchange, systems] = system;
  const LeavingField leaving(mesh, options.leaving);
  const QuickField rest(irradiance.rest);
  std::vector<ProbePlace> probes =
      spread_probes(mesh, options.weight, options.shares, options.points, options.use);
  ReflectionEstimate estimate;
  estimate.complete = parallel_for(
      probes.size(),
      [&](std::size_t i) {
        ProbePlace& probe = probes[i];
        const int e = probe.element;
        const TrianglePlace& place = probe.place;
        const Rgb here = rest.value(e, place);
        const RayOrigin from = ray_origin(scene, mesh, e, place);
        std::array<RayHemisphere, 2> halves;
        for (std::size_t h = 0; h < 2; ++h)
          halves[h] = {from, options.strata[at(e)], mix_bits(probe.seed + h)};
        GatheredRays rays = gather_rays(scene, light, Looks::exact, halves);
        probe.reach = share_that_ends(rays.traced);
        const ChannelArray found = gathered(std::move(rays), mesh.forest, leaving);
        const Rgb first = found.row(0).transpose() - here, second = found.row(1).transpose() - here;
        probe.square_error = (first * second).sum();
        probe.missing = (first + second) / 2;
        const Rgb constant = irradiance.constant.row(systems.of_element[at(e)]).transpose();
        probe.square = light.square_beside_known(
            light.direct_at(mesh.root(e), mesh.position(e, place)), here + constant);
      },
      progress, "error of reflected light");
  estimate.add(mesh, probes, light.direct_square.value_or(0));
  for (const ProbePlace& probe : probes)
    estimate.rays += 2 * rays_of_hemisphere(light, options.strata[at(probe.element)]);
  return estimate;
}

}  // namespace halfshade
