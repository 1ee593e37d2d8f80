#include "apps/check_outputs.h"
#include "apps/commands.h"
#include "apps/scene_turning.h"
#include "io/write/write_curves.h"
#include "io/write/write_mesh.h"
#include "io/write/write_report.h"
#include "meshing/repair/repair_sentence.h"
#include "solver/pipeline/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace halfshade {
namespace {

/// A camera's up counts for a surface if the cosine of its angle with the normal is smaller.
constexpr double clearly_across = 0.7;

void check(const MeshCommand& command, const std::filesystem::path& json) {
  require_folder(json);
  for (const auto& path : command.outputs) check_output(path, mesh_formats);
  check_output(command.curves, curve_formats);
  check_output(command.picture, picture_formats);
}

/// Draws the part of the scene asked for; up as in the scene's first camera.
void draw(const MeshCommand& command, const PreparedScene& prepared, const MeshResult& result,
          const Context& context) {
  CurvePictureOptions options = command.picture_options;
  const std::vector<int> surfaces =
      picture_surfaces(result.scene, result.found, command.picture_of);
  if (!result.cameras.empty()) {
    // Of a camera that looks along the normal, the picture's up; of others, where it looks to.
    const Camera& camera = result.cameras.front();
    const Vec3& normal =
        result.scene.surfaces[static_cast<std::size_t>(surfaces.front())].frame.normal;
    const Vec3 up = camera.up.stableNormalized(), ahead = camera.direction.stableNormalized();
    options.up = std::abs(up.dot(normal)) < std::abs(ahead.dot(normal)) ? up : ahead;
    if (std::abs(up.dot(normal)) < clearly_across) options.up = up;
  }
  write_png(draw_curves(result.scene, prepared.direct_light(), result.found, surfaces, options,
                        context.progress),
            command.picture);
}

void print_curves(const Discontinuities& found) {
  std::array<std::size_t, 4> kinds{};
  std::array<std::size_t, 3> orders{};
  for (const DiscontinuityCurve& curve : found.curves) {
    ++kinds.at(static_cast<std::size_t>(curve.kind));
    ++orders.at(static_cast<std::size_t>(std::clamp(curve.order, 0, 2)));
  }
  fmt::print("curves       {} of {} source{}\n", found.curves.size(), found.sources.size(),
             found.sources.size() == 1 ? "" : "s");
  fmt::print("kinds        {} contact, {} face, {} ev, {} eee\n", kinds[0], kinds[1], kinds[2],
             kinds[3]);
  fmt::print("orders       {} D0, {} D1, {} D2\n", orders[0], orders[1], orders[2]);
}

void print_summary(const MeshResult& result, bool with_elements, bool verbose) {
  if (verbose)
    for (const Repair& repair : result.scene.repairs)
      fmt::print("repair       {}\n", sentence(repair, result.scene));
  fmt::print("surfaces     {}\n", result.scene.surfaces.size());
  print_curves(result.found);
  if (with_elements) {
    fmt::print("elements     {}\n", result.elements.count());
    fmt::print("left out     {} curves below {:.3g} W/m²\n", result.mesh.culled,
               result.irradiance_tolerance);
  }
  if (verbose)
    for (const StageReport& stage : result.stages)
      if (stage.left_out_because.empty())
        fmt::print("{:<12} {:.2f} s\n", stage.name, stage.seconds);
}

}  // namespace

int run(const MeshCommand& given, const Context& context) {
  MeshCommand command = given;
  if (command.outputs.empty() && command.curves.empty() && command.picture.empty())
    command.outputs.push_back(command.scene.stem().replace_extension(".vtu"));
  check(command, context.common.json);
  command.options.with_elements = !command.outputs.empty() || !context.common.json.empty();
  const SceneFile file = read_turned(command.scene, command.materials, context.common.orientation);
  const PreparedScene prepared(file.scene, context.progress);
  // Before the work: a name that does not exist is worth telling at once.
  if (!command.picture.empty() && !command.picture_of.empty())
    picture_surfaces(prepared.scene(), {}, command.picture_of);
  const MeshResult result = mesh_scene(prepared, command.options, context.progress);
  context.progress_ends();
  if (!context.common.quiet) print_warnings(file.warnings, result.warnings);
  std::vector<std::filesystem::path> written = command.outputs;
  for (const auto& path : command.outputs) write_mesh(result, context.provenance, path);
  if (!command.curves.empty()) {
    write_curves(result.scene, result.found, result.unit, context.provenance, command.curves);
    written.push_back(command.curves);
  }
  if (!command.picture.empty()) {
    draw(command, prepared, result, context);
    context.progress_ends();
    written.push_back(command.picture);
  }
  if (!context.common.json.empty())
    write_report(result, context.provenance, written, context.common.json);
  if (!context.common.quiet) {
    print_summary(result, command.options.with_elements, context.common.verbose);
    for (const auto& path : written) fmt::print("wrote        {}\n", path.string());
  }
  if (!context.progress.stopped()) return exit_done;
  fmt::print(stderr, "interrupted: what was written is incomplete and marked so\n");
  return exit_interrupted;
}

}  // namespace halfshade
