#include "solver/pipeline/solve_fields.h"

#include "solver/elements/material_arrays.h"
#include "solver/pipeline/direct_field.h"

#include <fmt/format.h>

#include <cmath>

namespace halfshade {
namespace {

std::string sentence(const AdaptiveFieldReport& report, double tolerance) {
  std::string why;
  switch (report.limit) {
    case FieldLimit::none:
    case FieldLimit::samples:
    case FieldLimit::stopped:
    case FieldLimit::fixed:
      return {};
    case FieldLimit::elements:
      why = "more elements than --max-elements allows";
      break;
    case FieldLimit::unknowns:
      why = "more unknowns than --max-unknowns allows";
      break;
    case FieldLimit::rounds:
      why = "more rounds of refinement than it pays to make";
      break;
  }
  return fmt::format("the error is about {:.2g} instead of {:.2g}; less would take {}",
                     report.relative_error, tolerance, why);
}

}  // namespace

void solve_fields(const PreparedScene& prepared, const Plan& plan, const SolveOptions& options,
                  const Progress& progress, Stages& stages, SolveResult& result) {
  DirectField direct = find_direct_field(prepared, plan, options, progress, stages);
  result.discontinuities = direct.discontinuities;
  result.curves = direct.curves;
  result.mesh = direct.mesh;
  result.discontinuity_tolerance = direct.discontinuity_tolerance;
  result.refinement = direct.light.report;
  result.relative_error = direct.light.report.relative_error;
  result.not_reached = sentence(direct.light.report, options.tolerance);
  result.elements = std::move(direct.light.elements);
  result.direct = std::move(direct.light.field);
  result.irradiance = result.direct;

  const MaterialArrays materials = material_arrays(prepared.scene(), result.elements);
  Solution& solution = result.solution;
  solution.rho = materials.rho;
  solution.exitance = materials.exitance;
  solution.direct_irradiance = means(result.direct);
  solution.irradiance = means(result.irradiance);
  solution.radiosity = solution.exitance + solution.rho * solution.irradiance;
  solution.region = std::move(direct.region);
  // Of the channels' mean.
  solution.error_estimate = direct.light.error / std::sqrt(3.);
  result.radiosity.channels = plan.no_channels.empty() ? 3 : 1;
  stages.leave_out_if(true, "form factors", plan.no_factors);
  stages.leave_out_if(!plan.no_channels.empty(), "second and third channel", plan.no_channels);
}

}  // namespace halfshade
