#include "solver/pipeline/solve_fields.h"

#include "meshing/core/parallel.h"
#include "solver/elements/material_arrays.h"
#include "solver/elements/painted_triangle.h"
#include "solver/pipeline/direct_field.h"
#include "solver/pipeline/first_few.h"
#include "solver/pipeline/goal_correction.h"
#include "solver/pipeline/lamp_error.h"
#include "solver/pipeline/lit_surfaces.h"
#include "solver/pipeline/require_limits.h"
#include "solver/pipeline/result_error.h"
#include "solver/pipeline/straight_files.h"
#include "solver/pipeline/total_field.h"
#include "solver/pipeline/weak_lights.h"
#include "solver/reflected/reflected_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace halfshade {
namespace {

/// Of the tolerance: direct light, relative to it alone; values of reflected light on the elements
/// of direct light. Reflected light may be off by what they leave: squares sum to 1.
constexpr double direct_share = 0.5, values_share = 0.35;
/// Where direct light is what takes the time, as rays find it: more, for reflected light takes
/// little less if it has less, and what it adds to all irradiance makes the share of it smaller.
constexpr double direct_share_of_rays = 0.75;
/// The same for a goal, of bounds that add errors instead of their squares. The solution may be off
/// by so much more than the goal, for the residual corrects what that does but for the share of it
/// that the adjoint light is off; values do not enter it.
constexpr double direct_share_of_goal = 0.4, reflected_share_of_goal = 0.55;
constexpr double slack_of_goal = 0.5 / adjoint_tolerance;
/// Of the tolerance: standard deviation of the correction, and what light gathered for it may be
/// off.
constexpr double share_of_deviation = 0.2, share_of_gathering = 0.1;
constexpr double deviations_claimed = 2;

std::string reason(FieldLimit limit, bool by_rays = false) {
  switch (limit) {
    case FieldLimit::elements:
      return "more elements than --max-elements allows";
    case FieldLimit::unknowns:
      return "more unknowns than --max-unknowns allows";
    case FieldLimit::work:
      return by_rays ? "more rays to emitters than --max-unknowns allows"
                     : "more looks through faces behind faces than --max-unknowns allows";
    case FieldLimit::rounds:
      return "more rounds of refinement than it pays to make";
    default:
      return {};
  }
}

std::string reason(ReflectedEnd end) {
  switch (end) {
    case ReflectedEnd::elements:
      return "more elements of reflected light than there may be";
    case ReflectedEnd::rays:
      return "more rays of reflected light than there may be";
    case ReflectedEnd::gaps:
      return "surfaces that meet more closely: what closed parts of space lose between them, if "
             "these are gaps, is not known";
    case ReflectedEnd::rounds:
      return "more rounds of refining reflected light than it pays to make";
    default:
      return {};
  }
}

/// Why the accuracy asked for was not reached; with elements that were asked for none is.
std::string not_reached(const SolveResult& result, const SolveOptions& options,
                        const std::vector<std::string>& reasons) {
  if (options.refine == Refinement::uniform || result.relative_error <= options.tolerance)
    return {};
  const auto first =
      std::find_if(reasons.begin(), reasons.end(), [](const auto& text) { return !text.empty(); });
  const std::string of_what =
      result.goal ? fmt::format("the mean irradiance of '{}'", options.goal) : "the irradiance";
  return fmt::format(
      "the error is about {}{}{}", error_instead(result.relative_error, of_what, options.tolerance),
      first == reasons.end() ? "" : "; less would take ", first == reasons.end() ? "" : *first);
}

/// Of lights that are too weak beside others; empty if none are.
std::string weak_lights_lost(const SolveResult& result) {
  const std::vector<std::string> weak = weak_lights(result.scene, result.elements, result.solution);
  if (weak.empty()) return {};
  return fmt::format(
      "light of {} is so weak beside the strongest of the scene that what is "
      "reflected of it may get lost in double precision; --method matrix finds it, and "
      "so does a scene without the strongest",
      first_few(weak));
}

/// Whether a goal is: light of a number of reflections does not solve the equation whose residual
/// would do that.
bool is_corrected(const SolveOptions& options) { return options.radiosity.bounces <= 0; }

/// The tolerance of direct or reflected light that a goal takes.
double goal_tolerance(double share, const SolveOptions& options) {
  constexpr double most = 0.5;
  const double needed = share * options.tolerance;
  return is_corrected(options) ? std::min(slack_of_goal * needed, std::max(most, needed)) : needed;
}

AdaptiveFieldOptions values_options(const SoundScene& scene, const Plan& plan,
                                    const SolveOptions& options, double tolerance,
                                    const GoalWeights* goal) {
  AdaptiveFieldOptions result = field_options(scene, plan, options, goal);
  result.tolerance = values_share * tolerance;
  result.order = -1;
  result.highest_order = max_reflected_order;
  return result;
}

/// Of painted elements: the share that is reflected of what arrives, as it is spread over them.
void reflect_by_paint(const SoundScene& scene, const ElementTable& elements,
                      const ElementField& irradiance, ChannelArray& rho) {
  parallel_for(at(elements.count()), [&](std::size_t e) {
    const Surface& surface = scene.surfaces[at(elements.surface[e])];
    if (surface.paint < 0) return;
    const int element = static_cast<int>(e);
    const Rgb arriving = irradiance.of(element).row(0).transpose();
    const Rgb share = mean_reflected(scene, surface, elements, irradiance, element) / arriving;
    const Rgb& most = scene.materials[at(surface.material)].rho;
    for (int c = 0; c < 3; ++c)
      if (arriving[c] > 0) rho(element, c) = std::clamp(share[c], 0., most[c]);
  });
}

void fill_solution(const SoundScene& scene, const Eigen::ArrayXd& error, SolveResult& result) {
  const MaterialArrays materials = material_arrays(scene, result.elements);
  Solution& solution = result.solution;
  solution.rho = materials.rho;
  reflect_by_paint(scene, result.elements, result.irradiance, solution.rho);
  solution.exitance = materials.exitance;
  solution.direct_irradiance = means(result.direct);
  solution.irradiance = means(result.irradiance);
  solution.radiosity = solution.exitance + solution.rho * solution.irradiance;
  solution.error_estimate = error / std::sqrt(3.);  // of the channels' mean
}

/// What is not absorbed gets out, but for what the light is off.
void fill_powers(SolveResult& result) {
  const Eigen::Map<const Eigen::ArrayXd> areas(result.elements.area.data(),
                                               result.elements.count());
  const Solution& solution = result.solution;
  const bool is_closed = result.most_bounces < 0 && result.reflected.systems > 0 &&
                         result.reflected.systems == result.reflected.closed_systems;
  result.radiosity.systems = result.reflected.systems;
  result.radiosity.unknowns = static_cast<int>(result.refinement.unknowns);
  for (int c = 0; c < 3; ++c) {
    ChannelReport& channel = result.radiosity.channel[at(c)];
    channel.emitted_power = (areas * solution.exitance.col(c)).sum();
    channel.absorbed_power = (areas * (1 - solution.rho.col(c)) * solution.irradiance.col(c)).sum();
    const double left = channel.emitted_power - channel.absorbed_power;
    channel.escaped_power = is_closed ? 0 : std::max(left, 0.);
    if (channel.emitted_power > 0)
      channel.balance = std::abs(left - channel.escaped_power) / channel.emitted_power;
    channel.residual = result.reflected.residual;
    channel.iterations = result.reflected.iterations;
  }
}

/// ∫ error² of direct light, to the root.
double norm_of_error(const AdaptiveField& light) {
  const Eigen::Map<const Eigen::ArrayXd> areas(light.elements.area.data(), light.elements.count());
  return (areas.sqrt() * light.error).matrix().stableNorm();
}

/// ∫ |H_d|², to the root.
double norm_of_light(const AdaptiveField& light) {
  Eigen::ArrayXd of_elements(light.field.count());
  for (int e = 0; e < light.field.count(); ++e)
    of_elements[e] =
        std::sqrt(light.elements.area[at(e)]) * light.field.of(e).matrix().stableNorm();
  return of_elements.matrix().stableNorm();
}

/// Exact parts among few surfaces, if nothing else is asked for: noise of rays does not average out
/// over the few elements that a goal takes.
ReflectedVisibility visibility_for_goal(const SoundScene& scene, ReflectedVisibility asked) {
  constexpr std::size_t few_surfaces = 100;  // their visible parts are found at once
  return asked == ReflectedVisibility::automatic && scene.surfaces.size() <= few_surfaces
             ? ReflectedVisibility::exact
             : asked;
}

/// The goal asked for and what matters to it.
struct Goal {
  std::shared_ptr<const GoalAdjoint> adjoint;
  GoalWeights weights;
};

std::optional<Goal> find_goal(const SoundScene& scene, const SolveOptions& options,
                              const Progress& progress, Stages& stages) {
  if (options.goal.empty()) return std::nullopt;
  Goal goal;
  stages.run("importance for the goal", [&] {
    goal.adjoint = std::make_shared<const GoalAdjoint>(
        scene, halfshade::find_goal(scene, options.goal), options, progress);
    return at(goal.adjoint->elements());
  });
  goal.weights = weights_of(goal.adjoint);
  return goal;
}

/// The mean, corrected if it can be, and its error.
void fill_goal(const PreparedScene& prepared, const Goal& goal, const SolveOptions& options,
               const Progress& progress, Stages& stages, SolveResult& result) {
  const ReflectedLight* reflected = result.reflected_light ? &*result.reflected_light : nullptr;
  GoalResult found = goal_mean(goal.weights.group, result.elements, result.direct, reflected);
  // As many as direct light was found with, not with those of reflected light's values.
  found.unknowns += result.refinement.unknowns - at(result.direct.first.back());
  if (goal.weights.weight) {
    double error = goal.weights.norm * (result.refinement.relative_error + result.reflected.error);
    const char* const correction = "correction of the goal";
    stages.leave_out_if(!is_corrected(options), correction,
                        "light of a number of bounces leaves no residual to do it by");
    if (is_corrected(options))
      stages.run(correction, [&] {
        const GoalCorrection more =
            correct_goal(prepared, *goal.adjoint, {result.elements, result.direct, reflected},
                         share_of_deviation * options.tolerance * goal.weights.norm, progress);
        if (!more.complete) return std::size_t{0};
        found.mean += more.missing;
        error = goal.adjoint->error() * (error + more.moved.matrix().norm()) +
                deviations_claimed * more.deviation.matrix().norm();
        return more.points;
      });
    const double mean = found.mean.matrix().norm();
    result.relative_error = mean > 0 ? error / mean : 1;
    // The correction knows no other lamps, either.
    const double of_lamps = relative_lamp_error(options, result.direct, result.elements);
    result.relative_error = std::hypot(result.relative_error, of_lamps);
  }
  found.relative_error = result.relative_error;
  result.goal = found;
}

}  // namespace

ReflectedOptions reflected_options(const SoundScene& scene, const Plan& plan,
                                   const SolveOptions& options, double tolerance,
                                   const GoalWeights* goal) {
  ReflectedOptions result;
  result.counted = mark_surfaces(scene, plan.lit);
  result.visibility = options.visibility;
  result.tolerance = std::sqrt(1 - values_share * values_share) * tolerance;
  if (goal) {
    result.tolerance = goal_tolerance(reflected_share_of_goal, options);
    result.gather_tolerance = share_of_gathering * options.tolerance;
    result.visibility = visibility_for_goal(scene, options.visibility);
    result.weight = goal->weight;
    result.norm = goal->norm;
  }
  result.bounces = options.radiosity.bounces;
  result.each_bounce = options.each_bounce;
  result.through_operator = !plan.no_exact_direct_light.empty();
  // What arrives straight from emitters arrives by the operator's first application.
  if (result.through_operator && result.bounces >= 0) ++result.bounces;
  result.max_elements = options.max_elements;
  return result;
}

void solve_fields(const PreparedScene& prepared, const Plan& plan, const SolveOptions& asked_for,
                  const Progress& progress, Stages& stages, SolveResult& result) {
  SolveOptions options = asked_for;
  options.tolerance = tolerance_of_polynomials(asked_for);
  const bool reflects = plan.no_factors.empty();
  if (reflects) require_limits(prepared, options.radiosity, progress);
  const std::optional<Goal> asked = find_goal(prepared.scene(), options, progress, stages);
  const GoalWeights* goal = asked && asked->weights.weight ? &asked->weights : nullptr;
  SolveOptions direct_options = options;
  if (goal)
    direct_options.tolerance = goal_tolerance(direct_share_of_goal, options);
  else if (reflects)
    direct_options.tolerance *= plan.rays.deviation > 0 ? direct_share_of_rays : direct_share;
  direct_options.tolerance *= share_beside_lamps(options);
  const bool is_exact = plan.no_exact_direct_light.empty();
  stages.leave_out_if(!is_exact, "exact direct light", plan.no_exact_direct_light);
  stages.leave_out_if(!is_exact, "discontinuities", plan.no_discontinuities);
  DirectField direct =
      is_exact ? find_direct_field(prepared, plan, direct_options, progress, stages, goal)
               : no_direct_field(prepared.scene(), options, progress, stages);
  if (is_exact) add_lamp_error(options, direct.light);
  result.discontinuities = direct.discontinuities;
  result.curves = direct.curves;
  add(direct.warnings, result.warnings);
  result.mesh = direct.mesh;
  result.discontinuity_tolerance = direct.discontinuity_tolerance;
  result.refinement = direct.light.report;
  add(unknowns_warnings(result.refinement.unknowns, options.max_unknowns, result.refinement.rounds),
      result.warnings);
  result.patches = direct.patches;
  result.radiosity.channels = plan.no_channels.empty() ? 3 : 1;
  stages.leave_out_if(!reflects, "reflected light", plan.no_factors);
  stages.leave_out_if(!plan.no_channels.empty(), "second and third channel", plan.no_channels);

  Eigen::ArrayXd error;
  std::string of_values;
  if (reflects) {
    // Where direct light could not be had as exact, reflected light need not be more exact.
    const double of_direct = direct.light.report.relative_error;
    const double tolerance = std::max(options.tolerance, of_direct);
    ReflectedOptions of_reflected =
        reflected_options(prepared.scene(), plan, options, tolerance, goal);
    of_reflected.direct_norm = norm_of_light(direct.light);
    if (!goal && of_direct < options.tolerance)
      of_reflected.other_error = norm_of_error(direct.light);
    TotalField total = add_reflected_light(
        prepared.scene(), std::move(direct),
        {of_reflected, values_options(prepared.scene(), plan, options, tolerance, goal),
         options.radiosity.bounces < 0 ? options.final_gather : FinalGather::off},
        progress, stages);
    result.reflected = total.reflected->report();
    result.reflected_light = std::move(total.reflected);
    of_values = reason(total.values.limit);
    result.relative_error = total.relative_error;
    result.elements = std::move(total.elements);
    result.direct = std::move(total.direct);
    result.irradiance = std::move(total.irradiance);
    result.bounces = std::move(total.bounces);
    result.solution.region = std::move(total.region);
    error = std::move(total.error);
  } else {
    result.relative_error = direct.light.report.relative_error;
    result.elements = std::move(direct.light.elements);
    result.direct = std::move(direct.light.field);
    result.irradiance = result.direct;
    result.solution.region = std::move(direct.region);
    error = std::move(direct.light.error);
  }
  if (options.each_bounce)  // where nothing is reflected, too
    result.bounces.resize(at(options.radiosity.bounces),
                          zero_field(std::vector<int>(result.elements.corners.size(), 0)));
  if (asked) fill_goal(prepared, *asked, options, progress, stages, result);
  fill_solution(prepared.scene(), error, result);
  if (!is_exact) add_lamp_error(options, result);
  result.not_reached = not_reached(result, asked_for,
                                   {reason(result.refinement.limit, result.refinement.is_noisy),
                                    reason(result.reflected.end), of_values});
  if (reflects)
    if (std::string lost = weak_lights_lost(result); !lost.empty()) result.not_reached = lost;
  fill_powers(result);
  if (!asked && !progress.stopped())
    add(power_warnings(result.radiosity, asked_for.tolerance), result.warnings);
}

}  // namespace halfshade
