#include "solver/pipeline/solve.h"

#include "meshing/core/error.h"
#include "solver/adapt/recovery_estimate.h"
#include "solver/linear/system_solver.h"
#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve_light.h"
#include "solver/pipeline/solve_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace halfshade {
namespace {

void check(const SolveOptions& options) {
  if (options.elements < 1 || options.max_elements < 1 || !(options.max_length >= 0))
    throw Error(
        ErrorCode::contract, "solve",
        fmt::format("elements ({}) and max_elements ({}) must be at least 1 and max_length ({}) "
                    "not negative",
                    options.elements, options.max_elements, options.max_length));
  if (!(options.tolerance >= 0 && std::isfinite(options.tolerance)) || options.secondary < 0)
    throw Error(ErrorCode::contract, "solve",
                fmt::format("tolerance ({}) and secondary ({}) must be finite and not negative",
                            options.tolerance, options.secondary));
}

Discontinuities find_curves(const PreparedScene& prepared, const Plan& plan,
                            const SolveOptions& options, const Progress& progress, Stages& stages) {
  Discontinuities found;
  stages.leave_out_if(!plan.no_discontinuities.empty(), "discontinuities", plan.no_discontinuities);
  if (plan.no_discontinuities.empty())
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

/// What the geometry alone takes: known before the search for curves, for it may be too much.
struct PlainMesh {
  SolveMesh mesh;
  std::vector<StageReport> stages;
};

PlainMesh make_plain_elements(const SoundScene& scene, const SolveOptions& options,
                              const Progress& progress) {
  PlainMesh plain;
  Stages(plain.stages).run("mesh", [&] {
    plain.mesh = make_solve_mesh(scene, options, progress);
    return plain.mesh.elements.corners.size();
  });
  return plain;
}

/// A scene that takes no more elements than allowed.
struct Beginning {
  std::unique_ptr<const PreparedScene> prepared;
  PlainMesh plain;
  std::vector<Warning> warnings;
};

Beginning begin(const Scene& scene, const SolveOptions& options, const RepairOptions& repair,
                const Progress& progress) {
  Beginning beginning;
  beginning.prepared = std::make_unique<const PreparedScene>(scene, progress, repair);
  beginning.plain = make_plain_elements(beginning.prepared->scene(), options, progress);
  return beginning;
}

/// Without contact lines if they take too many elements: what nobody modelled, but a scanner or a
/// random generator made, cuts through itself everywhere.
Beginning begin(const Scene& scene, const SolveOptions& options, const Progress& progress) {
  try {
    return begin(scene, options, RepairOptions(), progress);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::too_large) throw;
  }
  Beginning beginning = begin(scene, options, {.contacts = false}, progress);
  beginning.warnings.push_back(contacts_warning(options.max_elements));
  return beginning;
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

void find_regions(const PreparedScene& prepared, const Progress& progress, Stages& stages,
                  SolveResult& result) {
  stages.run("regions", [&] {
    result.emitters = light_sources(prepared.scene());
    result.regions = label_elements(prepared.scene(), prepared.opaque(), result.elements,
                                    result.emitters, progress);
    return result.regions.size();
  });
}

/// `exchange_error` is independent of what the mesh does, in the mean.
void estimate_error(const Eigen::ArrayXd& exchange_error, Stages& stages, SolveResult& result) {
  stages.run("error estimate", [&] {
    // Squares of light of any size must not over- or underflow.
    const double scale = balancing_scale(result.solution.irradiance.maxCoeff());
    const ChannelArray irradiance = scale * result.solution.irradiance;
    const Eigen::ArrayXd of_exchange = scale * exchange_error;
    const Eigen::ArrayXd estimate =
        recovery_estimate(result.elements, irradiance)
            .binaryExpr(of_exchange, [](double a, double b) { return std::hypot(a, b); });
    result.solution.error_estimate = estimate / scale;
    result.relative_error = relative_error(result.elements, irradiance, estimate);
    double of_solver = 0;
    for (const ChannelReport& channel : result.radiosity.channel)
      of_solver = std::max(of_solver, channel.error);
    result.relative_error += of_solver;
    return result.elements.corners.size();
  });
}

/// From the plain mesh on.
SolveResult solve(const PreparedScene& prepared, PlainMesh plain, const SolveOptions& options,
                  const Progress& progress) {
  auto result = begin_result<SolveResult>(prepared);
  result.stages.insert(result.stages.end(), plain.stages.begin(), plain.stages.end());
  Stages stages(result.stages);

  const int plain_elements = plain.mesh.elements.count();
  const Plan plan = make_plan(prepared, options, progress, stages);
  const Discontinuities found = find_curves(prepared, plan, options, progress, stages);
  result.discontinuities = found.report;
  result.curves = found.curves.size();

  add(search_warnings(found.report, options.tolerance), result.warnings);

  SolveMesh mesh = make_elements(prepared.scene(), found, std::move(plain.mesh), plan, options,
                                 progress, stages);
  add(mesh_warnings({prepared.scene(), mesh.report.kept, plain_elements,
                     options.max_length > 0 ? 0 : options.elements, mesh.tolerance,
                     options.tolerance}),
      result.warnings);
  result.mesh = mesh.report;
  result.discontinuity_tolerance = mesh.tolerance;
  result.elements = std::move(mesh.elements);

  SolvedLight light = solve_light(prepared, result.elements, plan, options, progress, stages);
  result.exchange = light.exchange;
  result.radiosity = light.radiosity;
  result.solution = std::move(light.solution);

  if (options.regions) find_regions(prepared, progress, stages, result);
  estimate_error(light.exchange_error, stages, result);
  result.interrupted = progress.stopped();
  add(exchange_warnings(result.exchange), result.warnings);
  if (result.interrupted) return result;
  add(light_warnings(
          {result.scene, result.elements, result.solution, result.exchange, result.radiosity}),
      result.warnings);
  return result;
}

}  // namespace

SolveResult solve(const Scene& scene, const SolveOptions& options, const Progress& progress) {
  check(options);
  Beginning beginning = begin(scene, options, progress);
  SolveResult result = solve(*beginning.prepared, std::move(beginning.plain), options, progress);
  result.warnings.insert(result.warnings.begin(), beginning.warnings.begin(),
                         beginning.warnings.end());
  return result;
}

SolveResult solve(const PreparedScene& prepared, const SolveOptions& options,
                  const Progress& progress) {
  check(options);
  return solve(prepared, make_plain_elements(prepared.scene(), options, progress), options,
               progress);
}

}  // namespace halfshade
