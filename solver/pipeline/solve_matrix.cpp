#include "solver/pipeline/solve_matrix.h"

#include "solver/adapt/recovery_estimate.h"
#include "solver/elements/balancing_scale.h"
#include "solver/elements/vertex_interpolation.h"
#include "solver/pipeline/lamp_error.h"
#include "solver/pipeline/measured_error.h"
#include "solver/pipeline/require_limits.h"
#include "solver/pipeline/result_error.h"
#include "solver/pipeline/solve_light.h"
#include "solver/pipeline/solve_mesh.h"
#include "solver/pipeline/sources.h"
#include "solver/pipeline/subdivide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace halfshade {
namespace {

/// None if there is a reason `needless`.
Discontinuities find_curves(const PreparedScene& prepared, const Plan& plan,
                            const SolveOptions& options, const std::string& needless,
                            const Progress& progress, Stages& stages) {
  Discontinuities found;
  stages.leave_out_if(!needless.empty(), "discontinuities", needless);
  if (needless.empty())
    stages.run("discontinuities", [&] {
      DiscontinuityOptions events = options.events;
      events.eee = events.eee && plan.no_eee.empty();
      events.irradiance_tolerance = options.tolerance * plan.mean_irradiance;
      events.max_length = longest_edge(prepared.scene(), options);
      if (options.force.discontinuities)
        events.most_work = 0;
      else if (!(events.most_work > 0))
        events.most_work = affordable_work(options.tolerance);
      found =
          find_discontinuities(prepared.scene(), prepared.opaque(), plan.sources, events, progress);
      return found.curves.size();
    });
  stages.leave_out_if(plan.weak_sources > 0, "curves of weak sources",
                      fmt::format("{} of them give too little", plan.weak_sources));
  stages.leave_out_if(!plan.no_eee.empty(), "curves at three edges", plan.no_eee);
  return found;
}

/// Meshes the scene along its discontinuities if it has any.
SolveMesh make_elements(const SoundScene& scene, const Discontinuities& found, SolveMesh plain,
                        const Plan& plan, const SolveOptions& options, const Progress& progress,
                        Stages& stages) {
  if (found.curves.empty()) return plain;
  SolveMesh mesh;
  stages.run("mesh along curves", [&] {
    mesh = make_solve_mesh(scene, found, std::move(plain), options, plan.mean_irradiance, progress);
    return mesh.elements.corners.size();
  });
  return mesh;
}

/// `exchange_error` is independent of what the mesh does, in the mean. What is measured of direct
/// light counts beside what the recovery tells of all smooth light, also where it was asked to come
/// out of the matrix. Where most surfaces emit, it is smooth, and there is too much to look at.
void estimate_error(const PreparedScene& prepared, const Plan& plan, const SolveOptions& options,
                    const Eigen::ArrayXd& exchange_error, const Progress& progress, Stages& stages,
                    SolveResult& result) {
  stages.run("error estimate", [&] {
    std::vector<Eigen::ArrayXd> others = {exchange_error};
    if (plan.no_exact_direct_light.empty() || most_surfaces_emit(prepared.scene()).empty())
      others.push_back(
          measured_error(prepared, result.elements, result.solution.direct_irradiance, progress));
    // Squares of light of any size must not over- or underflow.
    const double scale = balancing_scale(result.solution.irradiance.maxCoeff());
    const ChannelArray irradiance = scale * result.solution.irradiance;
    Eigen::ArrayXd estimate = recovery_estimate(result.elements, irradiance);
    for (const Eigen::ArrayXd& other : others)
      estimate = estimate.binaryExpr(Eigen::ArrayXd(scale * other),
                                     [](double a, double b) { return std::hypot(a, b); });
    result.solution.error_estimate = estimate / scale;
    result.relative_error = error_of_elements_and_solver(result);
    add_lamp_error(options, result);
    return result.elements.corners.size();
  });
}

void interpolate(SolveResult& result) {
  result.irradiance = interpolated_field(result.elements, result.solution.irradiance);
  result.direct = interpolated_field(result.elements, result.solution.direct_irradiance);
  result.interpolated = true;
}

/// Why the error is larger than its estimate.
std::string not_resolved(const SolvedLight& light) {
  constexpr double often =
      5;  // as much light as this where it is seen wrongly is a good part of it
  if (light.in_gaps < often) return {};
  return fmt::format(
      "elements are longer than the gaps in which {:.2g} times the light put in is reflected, and "
      "do "
      "not show how much of it gets out; more --elements, or --method fields, tell more",
      light.in_gaps);
}

}  // namespace

void solve_matrix(const PreparedScene& prepared, const Plan& plan, const SolveOptions& options,
                  const Progress& progress, Stages& stages, SolveResult& result) {
  if (plan.no_factors.empty()) require_limits(prepared, options.radiosity, progress);
  // What the geometry alone takes comes before the search for curves, for it may be too much.
  SolveMesh plain;
  stages.run("mesh", [&] {
    plain = make_solve_mesh(prepared.scene(), options, progress);
    return plain.elements.corners.size();
  });
  const int plain_elements = plain.elements.count();
  const std::string no_room = no_elements_for_curves(plain_elements, options);
  const bool are_needless = !plan.no_discontinuities.empty();
  const Discontinuities found = find_curves(
      prepared, plan, options, are_needless ? plan.no_discontinuities : no_room, progress, stages);
  result.discontinuities = found.report;
  result.curves = found.curves.size();

  add(search_warnings(found.report, options.tolerance), result.warnings);

  SolveMesh mesh =
      make_elements(prepared.scene(), found, std::move(plain), plan, options, progress, stages);
  add(mesh_warnings({prepared.scene(), mesh.report.kept, plain_elements,
                     options.max_length > 0 ? 0 : options.elements, mesh.tolerance,
                     options.tolerance, are_needless || no_room.empty()}),
      result.warnings);
  result.mesh = mesh.report;
  result.discontinuity_tolerance = mesh.tolerance;
  result.elements = std::move(mesh.elements);

  SolvedLight light = solve_light(prepared, result.elements, plan, options, progress, stages);
  result.not_reached = not_resolved(light);
  if (options.subdivision.rounds > 0 && mesh.patches) {
    SubdividedLight divided = subdivide(prepared, plan, options, *std::move(mesh.patches),
                                        std::move(light), progress, stages);
    result.elements = std::move(divided.elements);
    result.subdivision = std::move(divided.report);
    light = std::move(divided.light);
  }
  result.exchange = light.exchange;
  result.radiosity = light.radiosity;
  result.solution = std::move(light.solution);
  estimate_error(prepared, plan, options, light.exchange_error, progress, stages, result);
  if (options.interpolate) interpolate(result);
  add(exchange_warnings(result.exchange), result.warnings);
}

}  // namespace halfshade
