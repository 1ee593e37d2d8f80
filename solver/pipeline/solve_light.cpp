#include "solver/pipeline/solve_light.h"

#include "solver/direct/direct_light.h"
#include "solver/elements/material_arrays.h"
#include "solver/exchange/estimated_factors.h"
#include "solver/pipeline/gap_light.h"
#include "solver/pipeline/level_error.h"
#include "solver/pipeline/require_limits.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Scenes that absorb less than this share of what arrives need more exact factors, up to this
/// share of the tolerance.
constexpr double commonly_absorbed = 0.01;
constexpr double most_exact = 1e-5;

/// In a closed enclosure everything an emitter sends arrives somewhere. Averaging over elements
/// loses or gains a little where shadows cut them; one factor for each emitter puts that right.
void conserve_power(ElementDirectLight& light, const SoundScene& scene,
                    const ElementTable& elements, const Exchange& exchange) {
  const Eigen::Map<const Eigen::ArrayXd> areas(elements.area.data(), elements.count());
  for (std::size_t k = 0; k < light.emitters.size(); ++k) {
    const auto first =
        std::find(elements.surface.begin(), elements.surface.end(), light.emitters[k]);
    const auto e = static_cast<int>(first - elements.surface.begin());
    if (first == elements.surface.end() || !exchange.enclosures.is_closed(e) ||
        exchange.lost[e] > 0)
      continue;
    auto factors = light.factor.col(static_cast<Eigen::Index>(k));
    const double arriving = (areas * factors).sum();
    if (arriving > 0) factors *= area(scene.surfaces[at(light.emitters[k])]) / arriving;
  }
}

ElementDirectLight find_direct_light(const PreparedScene& prepared, const ElementTable& elements,
                                     int points, const Progress& progress, Stages& stages) {
  ElementDirectLight light;
  stages.run("exact direct light", [&] {
    light =
        element_direct_light(prepared.scene(), elements, prepared.direct_light(), points, progress);
    return light.emitters.size();
  });
  return light;
}

Exchange find_exchange(const PreparedScene& prepared, const ElementTable& elements,
                       const ExchangeOptions& options, const std::string& needless,
                       const Progress& progress, Stages& stages) {
  if (!needless.empty()) {
    stages.leave_out_if(true, "form factors", needless);
    return enclosures_alone(prepared.scene(), elements);
  }
  Exchange exchange;
  stages.run("form factors", [&] {
    exchange =
        compute_exchange(prepared.scene(), elements, prepared.visibility(), options, progress);
    return exchange.report.factors;
  });
  stages.leave_out_if(exchange.report.rays == 0, "visibility rays",
                      options.factors == FactorsBy::exact
                          ? "visible parts are exact"
                          : "no surface can come between two others");
  stages.leave_out_if(!exchange.report.closure_enforced && !exchange.report.closed, "closure",
                      "light can leave the scene");
  return exchange;
}

/// Where nearly nothing is absorbed, light meets so many surfaces that what a factor is off adds
/// up.
ExchangeOptions needed_exactness(const SoundScene& scene, ExchangeOptions options) {
  double absorbed = 1;
  for (const Surface& surface : scene.surfaces)
    absorbed = std::min(absorbed, 1 - scene.materials[at(surface.material)].rho.maxCoeff());
  options.tolerance *= std::clamp(absorbed / commonly_absorbed, most_exact, 1.);
  return options;
}

}  // namespace

SolvedLight solve_light(const PreparedScene& prepared, const ElementTable& elements,
                        const Plan& plan, const SolveOptions& options, const Progress& progress,
                        Stages& stages) {
  const SoundScene& scene = prepared.scene();
  const bool is_exact = plan.no_exact_direct_light.empty();
  ElementDirectLight direct;
  stages.leave_out_if(!is_exact, "exact direct light", plan.no_exact_direct_light);
  if (is_exact)
    direct = find_direct_light(prepared, elements, options.direct_points, progress, stages);
  const Exchange exchange =
      find_exchange(prepared, elements, needed_exactness(scene, options.exchange), plan.no_factors,
                    progress, stages);
  ChannelArray direct_irradiance;
  if (is_exact) {
    if (options.exchange.closure != Closure::leave)
      conserve_power(direct, scene, elements, exchange);
    direct_irradiance = irradiance_of(direct, scene);
  }
  const MaterialArrays materials = material_arrays(scene, elements);
  require_limits(scene.groups, elements.group, exchange, materials, options.radiosity);
  SolvedLight light;
  light.exchange = exchange.report;
  RadiosityOptions radiosity_options = options.radiosity;
  radiosity_options.all_channels = plan.no_channels.empty();
  stages.run("radiosity", [&] {
    light.solution = solve_radiosity(exchange, materials.rho, materials.exitance, direct_irradiance,
                                     radiosity_options, light.radiosity, progress);
    light.solution.region = std::move(direct.region);
    const ChannelArray& sent = light.solution.radiosity;
    const Eigen::ArrayXd estimated =
        estimation_error(exchange, is_exact ? ChannelArray(sent - materials.exitance) : sent);
    const Eigen::ArrayXd of_level =
        level_error(elements, exchange, materials, light.solution.irradiance);
    light.exchange_error =
        estimated.binaryExpr(of_level, [](double a, double b) { return std::hypot(a, b); });
    light.in_gaps = light_in_gaps(exchange, materials, light.solution.irradiance);
    return static_cast<std::size_t>(light.radiosity.unknowns);
  });
  stages.leave_out_if(light.radiosity.unknowns == 0, "interreflection", "no surface reflects");
  stages.leave_out_if(!plan.no_channels.empty(), "second and third channel", plan.no_channels);
  return light;
}

}  // namespace halfshade
