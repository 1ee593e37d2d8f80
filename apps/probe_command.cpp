#include "apps/command_files.h"
#include "apps/console.h"
#include "apps/run_end.h"
#include "io/files/same_file.h"
#include "io/picture/result_file.h"
#include "io/read/read_points.h"
#include "io/write/write_points.h"
#include "meshing/core/error.h"
#include "solver/pipeline/hidden_lamps.h"
#include "solver/pipeline/light_at_points.h"
#include "solver/pipeline/limits.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/saved_light.h"
#include "solver/pipeline/surface_finder.h"
#include "solver/pipeline/surface_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>

namespace halfshade {
namespace {

/// Points computed at a time are lost when the user interrupts: few at first, then twice as many as
/// long as they take less than this.
constexpr std::size_t first_block = 64;
constexpr std::chrono::milliseconds short_time(500);

/// The same progress as a part of a larger whole that begins at `done` and takes `share` of it.
Progress part_of(const Progress& progress, double done, double share) {
  return {progress.stop, [&progress, done, share](std::string_view stage, double fraction) {
            progress(stage, done + share * fraction);
          }};
}

/// Calls `compute` for block after block of points until all are done or the user stops; returns
/// how many are done.
template <class Point, class Compute>
std::size_t in_blocks(std::span<const Point> points, const Progress& progress, Compute compute) {
  const auto count = static_cast<double>(points.size());
  std::size_t block = first_block;
  for (std::size_t done = 0; done < points.size();) {
    const auto start = std::chrono::steady_clock::now();
    const auto some = points.subspan(done, std::min(block, points.size() - done));
    compute(done, some,
            part_of(progress, static_cast<double>(done) / count,
                    static_cast<double>(some.size()) / count));
    if (progress.stopped()) return done;
    done += some.size();
    if (std::chrono::steady_clock::now() - start < short_time) block *= 2;
  }
  return points.size();
}

/// Exact direct light at the points that were reached before the user stopped.
std::vector<DirectLight> direct_light(const DirectLightIndex& index,
                                      std::span<const SurfacePoint> points,
                                      const Progress& progress) {
  std::vector<DirectLight> light;
  light.reserve(points.size());
  const std::size_t done = in_blocks(
      points, progress, [&](std::size_t, std::span<const SurfacePoint> some, const Progress& p) {
        const std::vector<DirectLight> next = index.irradiance(some, p);
        light.insert(light.end(), next.begin(), next.end());
      });
  light.resize(done);
  return light;
}

/// Adds the light that `solved` reflects to the points that were reached; drops the others.
template <class Solved>
void add_reflected(const Solved& solved, double tolerance, std::span<const FieldPoint> points,
                   const Progress& progress, std::vector<DirectLight>& light) {
  const std::size_t done =
      in_blocks(points.first(light.size()), progress,
                [&](std::size_t first, std::span<const FieldPoint> some, const Progress& p) {
                  add_gathered_light(solved, tolerance, some,
                                     std::span(light).subspan(first, some.size()), p);
                });
  light.resize(done);
}

/// A solution that was read.
struct ReadSolution {
  ReflectedLight light;
  double tolerance;         ///< that rays suit
  std::string not_reached;  ///< why it is not as accurate as asked for; empty if it is
};

std::optional<ReadSolution> get_solution(const ProbeCommand& command,
                                         const std::optional<ResultFile>& given,
                                         const SoundScene& scene, const Progress& progress) {
  if (!given) return std::nullopt;
  const ResultFile& file = *given;
  if (file.bounces >= 0)
    throw Error(ErrorCode::invalid_input, command.solution.string(),
                fmt::format("the light in it was reflected {} times at most; reflected light is "
                            "gathered from all light",
                            file.bounces));
  const double error = file.achieved_error;
  const bool suits_file = !command.has_tolerance && error > 0;
  ReadSolution solution{reflection_of(scene, saved_light(file), progress),
                        suits_file ? error : command.options.tolerance,
                        {}};
  if (error > solution.tolerance)
    solution.not_reached = fmt::format(
        "the error of the solution that was given is about {:.2g} of the irradiance "
        "instead of {:.2g}",
        error, solution.tolerance);
  if (file.interrupted) solution.not_reached = "the solution that was given is incomplete";
  return solution;
}

/// Adds reflected light of a solution that was read, or is made now. Returns why it is not as
/// accurate as asked for; empty if it is.
std::string add_reflected(const ProbeCommand& command, const PreparedScene& prepared,
                          const std::optional<ReadSolution>& read,
                          std::span<const FieldPoint> points, const Progress& progress,
                          std::vector<DirectLight>& light) {
  if (read) {
    add_reflected(read->light, read->tolerance, points, progress, light);
    return read->not_reached;
  }
  const SolveResult solved = solve(prepared, command.options, progress);
  if (solved.interrupted) light.clear();
  add_reflected(solved, command.options.tolerance, points, progress, light);
  return solved.not_reached;
}

ReferenceLight reference_light(const ProbeCommand& command, const SoundScene& scene,
                               std::span<const SurfacePoint> points, const Progress& progress) {
  std::vector<ReferencePoint> places;
  for (const SurfacePoint& point : points) places.push_back({point.position, point.normal});
  ReferenceLight light;
  in_blocks(points, progress,
            [&](std::size_t first, std::span<const SurfacePoint> some, const Progress& p) {
              ReferenceOptions options;
              options.samples = command.samples;
              options.bounces = command.direct_only ? 0 : -1;
              options.first = first;
              const ReferenceLight next =
                  reference_light(scene, std::span(places).subspan(first, some.size()), options, p);
              if (!next.complete) return;
              light.values.insert(light.values.end(), next.values.begin(), next.values.end());
              light.standard_errors.insert(light.standard_errors.end(),
                                           next.standard_errors.begin(),
                                           next.standard_errors.end());
            });
  return light;
}

CommandFiles checked_files(const ProbeCommand& command, const CommonOptions& common) {
  CommandFiles files = scene_files(command.scene, command.materials, common);
  files.inputs.push_back({"--points", command.points});
  files.inputs.push_back({"--solution", command.solution});
  add_outputs(files, "-o", {command.output});
  require_apart(files);
  require_place(common.json);
  if (!is_standard_stream(command.output)) check_output(command.output, point_formats);
  return files;
}

/// Those of the file, or else on a grid.
PointTable get_points(const ProbeCommand& command, const std::optional<PointTable>& given,
                      const SoundScene& scene) {
  return given ? *given : point_table(surface_grid(scene, command.group, command.spacing));
}

/// Writes table and report, and says so.
template <class Light>
ExitCode finish(const ProbeCommand& command, const PointTable& table, const Light& light,
                std::size_t done, const std::string& not_reached, const Context& context) {
  const std::size_t points = table.points.size();
  const ExitCode code = done < points          ? exit_interrupted
                        : !not_reached.empty() ? exit_not_accurate
                                               : exit_done;
  if (done == 0 && code == exit_interrupted) return end_without_results();
  write_points(table, light, command.output);
  if (!context.common.json.empty())
    write_report(ProbeReport{points, done, command.direct_only},
                 run_info(context, code, {command.output}), context.common.json);
  if (!context.common.quiet) {
    fmt::print(context.summary, "points       {}\n", done);
    if (context.common.verbose)
      fmt::print(context.summary, "{:<12} {:.2f} s\n", "probe",
                 run_info(context, code, {}).seconds);
    print_outputs(context, {command.output});
  }
  if (code == exit_interrupted)
    complain("interrupted: {} of {} points were computed and written\n", done, points);
  if (code == exit_not_accurate)
    complain("{}; the values at points are no more accurate\n", not_reached);
  return code;
}

/// Why light of lamps with pictures, or of those that rounding hides, is not as accurate as asked
/// for; empty if it is.
std::string lamps_limit(const SceneFile& file, const SoundScene& scene) {
  if (!file.lamps.is_limited) return hidden_lamps(scene);
  return fmt::format(
      "lamps with pictures would have to be cut into more pieces: theirs leave about {:.2g} of "
      "direct light, if nothing is in between, and may leave more where {:.2g} is asked for",
      file.lamps.relative_error, file.lamps.tolerance);
}

/// What lamps with pictures are cut for: as those of the solution that is given, for it is of their
/// pieces.
double lamp_tolerance(const ProbeCommand& command, const std::optional<ResultFile>& solution) {
  if (solution) return solution->lamp_tolerance;
  const bool is_exact = !command.has_tolerance && (command.direct_only || command.reference);
  return is_exact ? exact_lamp_tolerance : command.options.tolerance;
}

ExitCode run_prepared(const ProbeCommand& command, const SceneFile& file,
                      const std::optional<PointTable>& given,
                      const std::optional<ResultFile>& solution, const PreparedScene& prepared,
                      const Context& context) {
  const PointTable table = get_points(command, given, prepared.scene());
  const std::vector<FieldPoint> places = on_surfaces(prepared, table.points);
  std::vector<SurfacePoint> points;
  for (const FieldPoint& place : places) points.push_back(place.point);
  const auto end = [&] {
    context.progress_ends();
    print_warnings(file, prepared.warnings(), context);
  };
  if (command.reference) {
    const ReferenceLight light =
        reference_light(command, prepared.scene(), points, context.progress);
    end();
    return finish(command, table, light, light.values.size(), lamps_limit(file, prepared.scene()),
                  context);
  }
  const std::optional<ReadSolution> read =
      get_solution(command, solution, prepared.scene(), context.progress);
  std::vector<DirectLight> light = direct_light(prepared.direct_light(), points, context.progress);
  std::string not_reached;
  if (!command.direct_only)
    not_reached = add_reflected(command, prepared, read, places, context.progress, light);
  end();
  if (not_reached.empty()) not_reached = lamps_limit(file, prepared.scene());
  return finish(command, table, light, light.size(), not_reached, context);
}

}  // namespace

ExitCode run(const ProbeCommand& command, const Context& context) {
  const CommandFiles files = checked_files(command, context.common);
  std::optional<ResultFile> solution;
  if (!command.solution.empty()) solution = read_result(command.solution);
  const SceneFile file = read_scene(command.scene, command.materials, context.common.orientation,
                                    files, lamp_tolerance(command, solution));
  require_three_channels(file, "probe");
  std::optional<PointTable> given;
  if (!command.points.empty()) given = read_points(command.points);
  // Contact lines are for elements; exact light needs none.
  const SolveOptions options = with_limits(command.options, file.scene.faces.size());
  ContactLimit limit{static_cast<double>(options.max_elements), {}};
  if (!command.direct_only) limit.warning = contacts_warning();
  return use_prepared(file.scene, limit, context.progress, [&](const PreparedScene& prepared) {
    return run_prepared(command, file, given, solution, prepared, context);
  });
}

}  // namespace halfshade
