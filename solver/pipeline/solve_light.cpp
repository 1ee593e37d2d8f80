#include "solver/pipeline/solve_light.h"

#include "solver/direct/direct_light.h"
#include "solver/elements/material_arrays.h"

#include <algorithm>

namespace halfshade {
namespace {

/// In a closed enclosure everything an emitter sends arrives somewhere. Averaging over elements
/// loses or gains a little where shadows cut them; one factor for each emitter puts that right.
void conserve_power(ElementDirectLight& light, const SoundScene& scene,
                    const ElementTable& elements, const Enclosures& enclosures) {
  const Eigen::Map<const Eigen::ArrayXd> areas(elements.area.data(), elements.count());
  for (std::size_t k = 0; k < light.emitters.size(); ++k) {
    const auto first =
        std::find(elements.surface.begin(), elements.surface.end(), light.emitters[k]);
    if (first == elements.surface.end() ||
        !enclosures.is_closed(static_cast<int>(first - elements.surface.begin())))
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
                       const ExchangeOptions& options, const Progress& progress, Stages& stages) {
  Exchange exchange;
  stages.run("form factors", [&] {
    exchange =
        compute_exchange(prepared.scene(), elements, prepared.visibility(), options, progress);
    return exchange.report.factors;
  });
  stages.leave_out_if(exchange.report.rays == 0, "visibility rays",
                      "no surface can come between two others");
  stages.leave_out_if(!exchange.report.closure_enforced && !exchange.report.closed, "closure",
                      "light can leave the scene");
  return exchange;
}

}  // namespace

SolvedLight solve_light(const PreparedScene& prepared, const ElementTable& elements,
                        const std::string& no_exact_direct_light, const SolveOptions& options,
                        const Progress& progress, Stages& stages) {
  const SoundScene& scene = prepared.scene();
  const bool is_exact = no_exact_direct_light.empty();
  ElementDirectLight direct;
  stages.leave_out_if(!is_exact, "exact direct light", no_exact_direct_light);
  if (is_exact)
    direct = find_direct_light(prepared, elements, options.direct_points, progress, stages);
  const Exchange exchange = find_exchange(prepared, elements, options.exchange, progress, stages);
  ChannelArray direct_irradiance;
  if (is_exact) {
    if (exchange.report.closure_enforced)
      conserve_power(direct, scene, elements, exchange.enclosures);
    direct_irradiance = irradiance_of(direct, scene);
  }
  const MaterialArrays materials = material_arrays(scene, elements);
  SolvedLight light;
  light.exchange = exchange.report;
  stages.run("radiosity", [&] {
    light.solution = solve_radiosity(exchange, materials.rho, materials.exitance, direct_irradiance,
                                     options.radiosity, light.radiosity, progress);
    light.solution.region = std::move(direct.region);
    return static_cast<std::size_t>(light.radiosity.unknowns);
  });
  stages.leave_out_if(light.radiosity.unknowns == 0, "interreflection", "no surface reflects");
  stages.leave_out_if(light.radiosity.channels == 1, "second and third channel",
                      "every material is grey");
  return light;
}

}  // namespace halfshade
