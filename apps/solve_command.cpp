#include "apps/command_files.h"
#include "apps/console.h"
#include "apps/run_end.h"
#include "io/files/same_file.h"
#include "io/read/read_factors.h"
#include "io/read/read_points.h"
#include "io/write/write_points.h"
#include "io/write/write_series.h"
#include "meshing/core/error.h"
#include "solver/pipeline/face_radiosity.h"
#include "solver/pipeline/heat_sums.h"
#include "solver/pipeline/net_exchange.h"
#include "solver/pipeline/result_error.h"
#include "solver/pipeline/straight_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

namespace halfshade {
namespace {

constexpr FileFormats solve_formats = {"results", {".vtu", ".vtp", ".ply", ".png"}};

void write(const SolveResult& result, const SolveCommand& command, const Context& context,
           const std::filesystem::path& path) {
  if (!has_format(path, picture_formats))
    return write_result(result, context.provenance, path, command.result_options);
  const ShadedMesh mesh = shaded(result);
  Picture picture = draw(mesh, default_camera(mesh));
  if (result.interrupted) picture.comment = "interrupted: the solution is not complete";
  write_png(picture, path);
}

std::string closure_line(const ExchangeReport& exchange) {
  if (!exchange.closed)
    return fmt::format("open scene, {:.3g} of the light escapes", exchange.escaping_fraction);
  return fmt::format("closed scene, closure error {:.2g} (largest {:.2g}){}",
                     exchange.closure_error_rms, exchange.closure_error_max,
                     exchange.closure_enforced ? ", put right" : ", left as it is");
}

void print_matrix(const SolveResult& result, std::FILE* out) {
  fmt::print(out, "factors      {}, {} rays, {}\n", result.exchange.factors, result.exchange.rays,
             closure_line(result.exchange));
  const ChannelReport& channel = result.radiosity.channel[0];
  fmt::print(out,
             "radiosity    {} channel{}, {} iterations, residual {:.1e}, power balance {:.1e}\n",
             result.radiosity.channels, result.radiosity.channels == 1 ? "" : "s",
             channel.iterations, channel.residual, channel.balance);
}

void print_fields(const SolveResult& result, std::FILE* out) {
  const auto [low, high] =
      std::minmax_element(result.direct.order.begin(), result.direct.order.end());
  fmt::print(out, "direct light {} unknowns, orders {} to {}, {} samples in {} rounds\n",
             result.refinement.unknowns, *low, *high, result.refinement.samples,
             result.refinement.rounds);
  const ReflectedReport& reflected = result.reflected;
  if (reflected.elements > 0)
    fmt::print(
        out, "reflected    {} elements, {}, {} iterations, error {:.2g}\n", reflected.elements,
        reflected.is_exact ? fmt::format("exactly visible parts in {} rounds", reflected.rounds)
                           : fmt::format("{} rays", reflected.rays),
        reflected.iterations, reflected.error);
}

void print_goal(const SolveResult& result, std::FILE* out) {
  const GoalResult& goal = *result.goal;
  fmt::print(out, "goal         mean irradiance of '{}': {:.6g} {:.6g} {:.6g} W/m², {} unknowns\n",
             result.scene.groups.at(static_cast<std::size_t>(goal.group)), goal.mean[0],
             goal.mean[1], goal.mean[2], goal.unknowns);
  fmt::print(out, "error        {:.2g} relative to that mean (estimated)\n", goal.relative_error);
}

void print_summary(const SolveResult& result, double asked_tolerance, const Context& context) {
  std::FILE* out = context.summary;
  const bool verbose = context.common.verbose;
  print_repairs(result.scene, context);
  fmt::print(out, "surfaces     {}\n", result.scene.surfaces.size());
  fmt::print(out, "elements     {}\n", result.elements.count());
  if (result.subdivision.patches > 0)
    fmt::print(out, "subdivided   {} patches, then {} elements\n", result.subdivision.patches,
               fmt::join(result.subdivision.elements, ", "));
  if (result.curves > 0)
    fmt::print(out, "curves       {} of {}{}\n", result.mesh.kept, result.curves,
               result.discontinuity_tolerance > asked_tolerance
                   ? "; more would take more elements than asked for"
                   : "");
  if (result.direct.count() > 0 && !result.interpolated)
    print_fields(result, out);
  else
    print_matrix(result, out);
  if (result.goal)
    print_goal(result, out);
  else
    fmt::print(out, "error        {:.2g} relative to the irradiance (estimated, L2)\n",
               error_of_files(result));
  if (is_cut(result))
    fmt::print(out, "straight     {} triangles, {:.2g} off the polynomials\n",
               result.straight.pieces(), result.straight.relative_error);
  for (const StageReport& stage : result.stages)
    if (!stage.left_out_because.empty())
      fmt::print(out, "left out     {}: {}\n", stage.name, stage.left_out_because);
    else if (verbose)
      fmt::print(out, "{:<12} {:.2f} s\n", stage.name, stage.seconds);
}

/// Whether there is light beyond what is given. Before that a file of an earlier run is worth more.
bool is_worth_writing(const SolveResult& result) {
  return !result.interrupted || (result.solution.irradiance > 0).any();
}

/// Says so where elements that were asked for are too few for a tolerance that was asked for, too.
void require_tolerance(const SolveCommand& command, SolveResult& result) {
  const double tolerance = command.options.tolerance, error = error_of_files(result);
  if (command.needs_tolerance && result.not_reached.empty() && error > tolerance)
    result.not_reached = "with these elements the error is about " +
                         error_instead(error, "the irradiance", tolerance);
}

ExitCode exit_code(const SolveResult& result) {
  if (result.interrupted) return exit_interrupted;
  return result.radiosity.converged && result.not_reached.empty() ? exit_done : exit_not_accurate;
}

void print_ending(ExitCode code, const SolveResult& result) {
  if (code == exit_interrupted)
    complain(
        "interrupted: the results written are incomplete and marked so; they are off by about "
        "{:.2g} of the irradiance\n",
        error_of_files(result));
  if (code != exit_not_accurate) return;
  if (!result.not_reached.empty())
    complain("{}; the results written are marked so\n", result.not_reached);
  else
    complain(
        "the radiosity iteration did not reach its tolerance; the results written are marked so\n");
}

/// Throws Error(usage) unless there will be stages and their folder is for them alone, and
/// Error(unwritable) if it cannot be one.
void check_series(const SolveCommand& command, std::vector<std::filesystem::path> outputs,
                  const std::filesystem::path& report) {
  const std::filesystem::path& folder = command.progressive;
  if (folder.empty()) return;
  const RadiosityOptions& radiosity = command.options.radiosity;
  if (command.options.method != SolveMethod::matrix || !shoots(radiosity.solver) ||
      radiosity.bounces >= 0 || command.options.subdivision.rounds > 0)
    throw Error(ErrorCode::usage, "--progressive",
                "stages are of shooting: give --method matrix and --solver southwell or "
                "southwell-ambient, and neither --bounces nor --subdivide");
  outputs.insert(outputs.end(), {command.values, report});
  for (const auto& path : outputs)
    if (is_of_series(path) && is_same_file(path, folder / path.filename()))
      throw Error(ErrorCode::usage, path.string(),
                  "a result of this name would be one of the series of --progressive; give it "
                  "another name");
  require_folder(folder);
}

/// Throws Error(usage) for options of constant elements where there are none.
void check_method(const SolveOptions& options) {
  if (options.method == SolveMethod::matrix) return;
  if (options.subdivision.rounds > 0 || options.interpolate)
    throw Error(ErrorCode::usage, options.interpolate ? "--interpolate" : "--subdivide",
                "this is for constant elements; give --method matrix");
}

CommandFiles checked_files(const SolveCommand& command,
                           const std::vector<std::filesystem::path>& outputs,
                           const CommonOptions& common) {
  CommandFiles files = scene_files(command.scene, command.materials, common);
  files.inputs.push_back({"--points", command.points});
  add_factor_inputs(files, "--factors", command.factors);
  add_outputs(files, "-o", outputs);
  add_outputs(files, "--values", {command.values});
  require_apart(files);
  require_place(common.json);
  for (const auto& path : outputs) check_output(path, solve_formats);
  if (!is_standard_stream(command.values)) check_output(command.values, value_formats);
  return files;
}

SolveResult solved(const SceneFile& file, const SolveCommand& command, const Context& context) {
  SolveOptions options = command.options;
  options.lamp_error = file.lamps.error;
  Heat heat = file.heat;
  if (command.surroundings > 0) heat.surroundings = command.surroundings;
  heat.is_given = heat.is_given || heat.surroundings;
  // Better now than when the report is to be written.
  if (heat.is_given && !context.common.json.empty()) require_metres_in(file.scene.unit);
  const auto solve_scene = [&](const Scene& scene) {
    if (command.factors.empty()) return solve(scene, options, context.progress);
    return solve_by_faces(scene, read_factors(command.factors), options, context.progress);
  };
  if (heat.is_given)
    require_heat(file.scene, heat);
  else if (!command.factors.empty())
    require_emitter(file.scene);
  SolveResult result = solve_net_exchange(file.scene, heat, solve_scene);
  result.lamp_tolerance = file.lamps.tolerance;
  if (options.straight) cut_for_files(options, result);
  return result;
}

}  // namespace

ExitCode run(const SolveCommand& given, const Context& context) {
  SolveCommand command = given;
  std::vector<std::filesystem::path> outputs = command.outputs;
  if (outputs.empty() && command.values.empty() && command.progressive.empty())
    outputs.push_back(command.scene.stem().replace_extension(".vtu"));
  command.options.straight = std::any_of(outputs.begin(), outputs.end(), [&](const auto& path) {
    return holds_straight(path, command.result_options);
  });
  const CommandFiles files = checked_files(command, outputs, context.common);
  check_method(command.options);
  check_series(command, outputs, context.common.json);
  PointTable table;
  if (!command.points.empty()) table = read_points(command.points);
  const SceneFile file = read_scene(command.scene, command.materials, context.common.orientation,
                                    files, command.options.tolerance);
  SolveResult result = solved(file, command, context);
  require_tolerance(command, result);
  context.progress_ends();
  print_warnings(file, result.warnings, context);
  add(warnings_of(file), result.warnings);
  if (!is_worth_writing(result)) return end_without_results();
  for (const auto& path : outputs) write(result, command, context, path);
  if (!command.progressive.empty() && !result.radiosity.stages.empty())
    outputs.push_back(write_series(result, context.provenance, command.progressive));
  if (!command.values.empty()) {
    write_points(table, light_at_points(result, table.points), command.values);
    outputs.push_back(command.values);
  }
  const ExitCode code = exit_code(result);
  if (!context.common.json.empty())
    write_report(result, run_info(context, code, outputs), context.common.json);
  if (!context.common.quiet) {
    print_summary(result, command.options.tolerance, context);
    print_outputs(context, outputs);
  }
  print_ending(code, result);
  return code;
}

}  // namespace halfshade
