#include "apps/check_outputs.h"
#include "apps/commands.h"
#include "apps/scene_turning.h"
#include "io/read/read_points.h"
#include "io/write/write_points.h"
#include "io/write/write_report.h"
#include "solver/exchange/gather.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/surface_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace halfshade {
namespace {

/// Points computed at a time: what is lost of finished work when the user interrupts.
constexpr std::size_t block = 4096;

/// The same progress as a part of a larger whole that begins at `done` and takes `share` of it.
Progress part_of(const Progress& progress, double done, double share) {
  return {progress.stop, [&progress, done, share](std::string_view stage, double fraction) {
            progress(stage, done + share * fraction);
          }};
}

/// Calls `compute` for block after block of points until all are done or the user stops; returns
/// how many are done.
template <class Compute>
std::size_t in_blocks(std::span<const SurfacePoint> points, const Progress& progress,
                      Compute compute) {
  const auto count = static_cast<double>(points.size());
  for (std::size_t done = 0; done < points.size(); done += block) {
    const auto some = points.subspan(done, std::min(block, points.size() - done));
    compute(done, some,
            part_of(progress, static_cast<double>(done) / count,
                    static_cast<double>(some.size()) / count));
    if (progress.stopped()) return done;
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

/// Adds the light that was reflected to the points that were reached; drops the others.
void add_reflected(const PreparedScene& prepared, const SolveOptions& options,
                   std::span<const SurfacePoint> points, const Progress& progress,
                   std::vector<DirectLight>& light) {
  const SolveResult solved = solve(prepared, options, progress);
  if (solved.interrupted) return light.clear();
  const std::size_t done = in_blocks(
      points.first(light.size()), progress,
      [&](std::size_t first, std::span<const SurfacePoint> some, const Progress& p) {
        const std::vector<Rgb> reflected = reflected_irradiance(
            {prepared.scene(), solved.elements, solved.solution}, prepared.visibility(), some, p);
        for (std::size_t k = 0; k < some.size(); ++k) light[first + k].irradiance += reflected[k];
      });
  light.resize(done);
}

}  // namespace

int run(const ProbeCommand& command, const Context& context) {
  check_output(command.output, point_formats);
  const auto start = std::chrono::steady_clock::now();
  const SceneFile file = read_turned(command.scene, command.materials, context.common.orientation);
  const PreparedScene prepared(file.scene, context.progress);
  const PointTable table =
      command.points.empty()
          ? point_table(surface_grid(prepared.scene(), command.group, command.spacing))
          : read_points(command.points);
  std::vector<DirectLight> light =
      direct_light(prepared.direct_light(), table.points, context.progress);
  if (!command.direct_only)
    add_reflected(prepared, command.options, table.points, context.progress, light);
  context.progress_ends();
  if (!context.common.quiet) print_warnings(file.warnings, prepared.warnings());
  write_points(table, light, context.provenance, command.output);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const std::size_t points = table.points.size();
  if (!context.common.json.empty())
    write_report(ProbeReport{points, light.size(), command.direct_only, seconds.count()},
                 context.provenance, {command.output}, context.common.json);
  if (!context.common.quiet) {
    fmt::print("points       {}\n", light.size());
    if (context.common.verbose) fmt::print("{:<12} {:.2f} s\n", "probe", seconds.count());
    fmt::print("wrote        {}\n", command.output.string());
  }
  if (light.size() == points) return exit_done;
  fmt::print(stderr, "interrupted: {} of {} points were computed and written\n", light.size(),
             points);
  return exit_interrupted;
}

}  // namespace halfshade
