#include "apps/check_outputs.h"
#include "apps/commands.h"
#include "apps/scene_turning.h"
#include "io/write/write_report.h"
#include "meshing/repair/repair_sentence.h"

#include <fmt/format.h>

#include <cstdio>

namespace halfshade {
namespace {

constexpr FileFormats solve_formats = {"results", {".vtu", ".vtp", ".ply", ".png"}};

void write(const SolveResult& result, const Context& context, const std::filesystem::path& path) {
  if (!has_format(path, picture_formats)) return write_result(result, context.provenance, path);
  const ShadedMesh mesh = shaded(result);
  const Camera camera = mesh.cameras.empty() ? fitting_camera(mesh) : mesh.cameras.front();
  write_png(draw(mesh, camera), path);
}

std::string closure_line(const ExchangeReport& exchange) {
  if (!exchange.closed)
    return fmt::format("open scene, {:.3g} of the light escapes", exchange.escaping_fraction);
  return fmt::format("closed scene, closure error {:.2g} (largest {:.2g}){}",
                     exchange.closure_error_rms, exchange.closure_error_max,
                     exchange.closure_enforced ? ", put right" : ", left as it is");
}

void print_summary(const SolveResult& result, double asked_tolerance, bool verbose) {
  if (verbose)
    for (const Repair& repair : result.scene.repairs)
      fmt::print("repair       {}\n", sentence(repair, result.scene));
  fmt::print("surfaces     {}\n", result.scene.surfaces.size());
  fmt::print("elements     {}\n", result.elements.count());
  if (result.curves > 0)
    fmt::print("curves       {} of {}{}\n", result.mesh.kept, result.curves,
               result.discontinuity_tolerance > asked_tolerance
                   ? "; more would take more elements than asked for"
                   : "");
  fmt::print("factors      {}, {} rays, {}\n", result.exchange.factors, result.exchange.rays,
             closure_line(result.exchange));
  const ChannelReport& channel = result.radiosity.channel[0];
  fmt::print("radiosity    {} channel{}, {} iterations, residual {:.1e}, power balance {:.1e}\n",
             result.radiosity.channels, result.radiosity.channels == 1 ? "" : "s",
             channel.iterations, channel.residual, channel.balance);
  fmt::print("error        {:.2g} relative to the irradiance (estimated, L2)\n",
             result.relative_error);
  for (const StageReport& stage : result.stages)
    if (!stage.left_out_because.empty())
      fmt::print("left out     {}: {}\n", stage.name, stage.left_out_because);
    else if (verbose)
      fmt::print("{:<12} {:.2f} s\n", stage.name, stage.seconds);
}

}  // namespace

int run(const SolveCommand& command, const Context& context) {
  std::vector<std::filesystem::path> outputs = command.outputs;
  if (outputs.empty()) outputs.push_back(command.scene.stem().replace_extension(".vtu"));
  require_folder(context.common.json);
  for (const auto& path : outputs) check_output(path, solve_formats);
  const SceneFile file = read_turned(command.scene, command.materials, context.common.orientation);
  const SolveResult result = solve(file.scene, command.options, context.progress);
  context.progress_ends();
  if (!context.common.quiet) print_warnings(file.warnings, result.warnings);
  for (const auto& path : outputs) write(result, context, path);
  if (!context.common.json.empty())
    write_report(result, context.provenance, outputs, context.common.json);
  if (!context.common.quiet) {
    print_summary(result, command.options.tolerance, context.common.verbose);
    for (const auto& path : outputs) fmt::print("wrote        {}\n", path.string());
  }
  if (result.interrupted) {
    fmt::print(stderr, "interrupted: the results written are incomplete and marked so\n");
    return exit_interrupted;
  }
  if (!result.radiosity.converged) {
    fmt::print(
        stderr,
        "the radiosity iteration did not reach its tolerance; the results written are marked so\n");
    return exit_not_accurate;
  }
  return exit_done;
}

}  // namespace halfshade
