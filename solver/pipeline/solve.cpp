#include "solver/pipeline/solve.h"

#include "meshing/core/error.h"
#include "solver/pipeline/hidden_lamps.h"
#include "solver/pipeline/limits.h"
#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve_fields.h"
#include "solver/pipeline/solve_matrix.h"
#include "solver/pipeline/solve_mesh.h"

#include <fmt/format.h>

#include <cmath>

namespace halfshade {
namespace {

/// Numbers of reflections: each takes as much memory as all light.
constexpr int most_told_apart = 100;

void check(const SolveOptions& options) {
  if (options.elements < 1 || options.max_elements < 0 || !(options.max_length >= 0))
    throw Error(
        ErrorCode::contract, "solve",
        fmt::format("elements ({}) must be at least 1, max_elements ({}) and max_length ({}) not "
                    "negative",
                    options.elements, options.max_elements, options.max_length));
  if (!(options.deviation >= 0 && options.deviation < 1))
    throw Error(ErrorCode::contract, "solve",
                fmt::format("deviation ({}) must be in [0, 1)", options.deviation));
  if (options.method == SolveMethod::fields && options.tolerance == 0)
    throw Error(ErrorCode::usage, "solve",
                "no error at all cannot be reached; give a tolerance above 0");
  if (options.subdivision.rounds < 0 || !(options.subdivision.gradient > 0))
    throw Error(ErrorCode::contract, "solve",
                fmt::format("rounds of subdivision ({}) must not be negative and its gradient ({}) "
                            "be above 0",
                            options.subdivision.rounds, options.subdivision.gradient));
  if (options.each_bounce &&
      (options.method == SolveMethod::matrix || options.radiosity.bounces < 1 ||
       options.radiosity.bounces > most_told_apart))
    throw Error(ErrorCode::usage, "--each-bounce",
                fmt::format("this goes with --bounces N, N from 1 to {}, and not with the matrix",
                            most_told_apart));
  if (options.final_gather == FinalGather::on &&
      (options.method == SolveMethod::matrix || options.radiosity.bounces >= 0))
    throw Error(ErrorCode::usage, "--final-gather",
                "this goes with --method fields, not with the matrix, and with all bounces");
  if (options.method == SolveMethod::matrix && !options.goal.empty())
    throw Error(ErrorCode::usage, {}, "--goal goes with --method fields, not with the matrix");
  if (!(options.tolerance >= 0 && std::isfinite(options.tolerance)) || options.secondary < 0)
    throw Error(ErrorCode::contract, "solve",
                fmt::format("tolerance ({}) and secondary ({}) must be finite and not negative",
                            options.tolerance, options.secondary));
}

/// Refuses elements that are asked for by number and are more than there may be. Where surfaces and
/// contact lines alone are, it says that instead.
void require_within_limit(const SoundScene& scene, const SolveOptions& options,
                          const Progress& progress) {
  const bool is_number = options.max_length == 0 && (options.method == SolveMethod::matrix ||
                                                     options.refine == Refinement::uniform);
  if (!is_number || options.elements <= options.max_elements) return;
  PlanarMeshOptions coarsest;
  coarsest.min_angle = 0;
  coarsest.max_triangles = at(options.max_elements);
  mesh_plainly(scene, coarsest, options, progress);
  throw Error(ErrorCode::too_large, {},
              fmt::format("{} elements are asked for with --elements, and there may be {}; "
                          "--max-elements allows more",
                          options.elements, options.max_elements));
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

}  // namespace

SolveResult solve(const Scene& scene, const SolveOptions& options, const Progress& progress) {
  check(options);
  const SolveOptions limited = with_limits(options, scene.faces.size());
  const ContactLimit limit{static_cast<double>(limited.max_elements),
                           contacts_warning(limited.max_elements)};
  return use_prepared(scene, limit, progress, [&](const PreparedScene& prepared) {
    return solve(prepared, limited, progress);
  });
}

SolveResult solve(const PreparedScene& prepared, const SolveOptions& given,
                  const Progress& progress) {
  check(given);
  const SolveOptions options = with_limits(given, prepared.scene().surfaces.size());
  require_few_surfaces(prepared.scene(), options);
  require_within_limit(prepared.scene(), options, progress);
  if (!options.goal.empty()) find_goal(prepared.scene(), options.goal);
  auto result = begin_result<SolveResult>(prepared);
  result.most_bounces = options.radiosity.bounces;
  Stages stages(result.stages);
  const Plan plan = make_plan(prepared, options, progress, stages);
  const auto solve_by = options.method == SolveMethod::fields ? solve_fields : solve_matrix;
  solve_by(prepared, plan, options, progress, stages, result);
  if (options.regions) find_regions(prepared, progress, stages, result);
  result.interrupted = progress.stopped();
  if (result.interrupted) return result;
  add(light_warnings({result.scene, result.elements, result.solution, result.exchange,
                      result.radiosity, result.most_bounces}),
      result.warnings);
  if (const std::string hidden = hidden_lamps(prepared.scene()); !hidden.empty())
    result.not_reached = hidden;
  return result;
}

}  // namespace halfshade
