#include "apps/command_files.h"
#include "apps/console.h"
#include "apps/run_end.h"
#include "io/write/write_curves.h"
#include "io/write/write_mesh.h"
#include "meshing/core/error.h"
#include "solver/pipeline/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace halfshade {
namespace {

/// A camera's up counts for a surface if the cosine of its angle with the normal is smaller.
constexpr double clearly_across = 0.7;
/// Surfaces: the complete curves of more take hours, for all that can come between is in some way.
constexpr std::size_t many_surfaces = 20000;

CommandFiles checked_files(const MeshCommand& command, const CommonOptions& common) {
  CommandFiles files = scene_files(command.scene, command.materials, common);
  add_outputs(files, "-o", command.outputs);
  add_outputs(files, "--curves", {command.curves});
  add_outputs(files, "--picture", {command.picture});
  require_apart(files);
  require_place(common.json);
  for (const auto& path : command.outputs) check_output(path, mesh_formats);
  check_output(command.curves, curve_formats);
  check_output(command.picture, picture_formats);
  return files;
}

/// Draws the part of the scene asked for; up as in the scene's first camera. Returns false and
/// keeps what is there if the user stops: a picture does not show what of it is missing.
bool draw(const MeshCommand& command, const PreparedScene& prepared, const MeshResult& result,
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
  const Picture picture = draw_curves(result.scene, prepared.direct_light(), result.found, surfaces,
                                      options, context.progress);
  context.progress_ends();
  if (context.progress.stopped()) return false;
  write_png(picture, command.picture);
  return true;
}

void print_curves(const Discontinuities& found, std::FILE* out) {
  std::array<std::size_t, curve_kinds> kinds{};
  std::array<std::size_t, 4> orders{};
  for (const DiscontinuityCurve& curve : found.curves) {
    ++kinds.at(static_cast<std::size_t>(curve.kind));
    ++orders.at(static_cast<std::size_t>(std::clamp(curve.order, 0, 3)));
  }
  fmt::print(out, "curves       {} of {} source{}\n", found.curves.size(), found.sources.size(),
             found.sources.size() == 1 ? "" : "s");
  fmt::print(out, "kinds        {} contact, {} face, {} ev, {} eee, {} horizon\n", kinds[0],
             kinds[1], kinds[2], kinds[3], kinds[4]);
  fmt::print(out, "orders       {} D0, {} D1, {} D2, {} D3\n", orders[0], orders[1], orders[2],
             orders[3]);
}

void print_summary(const MeshResult& result, bool with_elements, const Context& context) {
  std::FILE* out = context.summary;
  const bool verbose = context.common.verbose;
  print_repairs(result.scene, context);
  fmt::print(out, "surfaces     {}\n", result.scene.surfaces.size());
  print_curves(result.found, out);
  if (with_elements) {
    fmt::print(out, "elements     {}\n", result.elements.count());
    fmt::print(out, "left out     {} curves below {:.3g} W/m²\n", result.mesh.culled,
               result.irradiance_tolerance);
  }
  if (verbose)
    for (const StageReport& stage : result.stages)
      if (stage.left_out_because.empty())
        fmt::print(out, "{:<12} {:.2f} s\n", stage.name, stage.seconds);
}

/// Writes what was asked for; returns what was written.
std::vector<std::filesystem::path> write(const MeshCommand& command, const PreparedScene& prepared,
                                         const MeshResult& result, const Context& context) {
  std::vector<std::filesystem::path> written = command.outputs;
  for (const auto& path : command.outputs) write_mesh(result, context.provenance, path);
  if (!command.curves.empty()) {
    write_curves(result.scene, result.found, command.curves);
    written.push_back(command.curves);
  }
  if (!command.picture.empty() && draw(command, prepared, result, context))
    written.push_back(command.picture);
  return written;
}

/// Not without being told to.
void require_time(const MeshCommand& command, const SoundScene& scene) {
  const DiscontinuityOptions& events = command.options.events;
  if (command.has_tolerance || scene.surfaces.size() <= many_surfaces ||
      !(events.ev || events.eee || events.face))
    return;
  throw Error(ErrorCode::too_large, {},
              fmt::format("all curves of {} surfaces take hours; --tolerance 0.01 leaves out those "
                          "that change the light by less, and --tolerance 0 takes all the time "
                          "there is",
                          scene.surfaces.size()));
}

ExitCode run_prepared(const MeshCommand& command, const SceneFile& file,
                      const PreparedScene& prepared, const Context& context) {
  // Before the work: a name that does not exist is worth telling at once.
  if (!command.picture.empty() && !command.picture_of.empty())
    picture_surfaces(prepared.scene(), {}, command.picture_of);
  require_time(command, prepared.scene());
  MeshResult result = mesh_scene(prepared, command.options, context.progress);
  context.progress_ends();
  print_warnings(file, result.warnings, context);
  add(warnings_of(file), result.warnings);
  if (result.interrupted && result.found.curves.empty()) return end_without_results();
  const auto written = write(command, prepared, result, context);
  const ExitCode code = context.progress.stopped() ? exit_interrupted : exit_done;
  if (!context.common.json.empty())
    write_report(result, run_info(context, code, written), context.common.json);
  if (!context.common.quiet) {
    print_summary(result, command.options.with_elements, context);
    print_outputs(context, written);
  }
  if (code == exit_interrupted)
    complain("interrupted: {}\n", result.interrupted
                                      ? "what was written is incomplete and marked so"
                                      : "the picture was not drawn");
  return code;
}

}  // namespace

ExitCode run(const MeshCommand& given, const Context& context) {
  MeshCommand command = given;
  if (command.outputs.empty() && command.curves.empty() && command.picture.empty())
    command.outputs.push_back(command.scene.stem().replace_extension(".vtu"));
  const CommandFiles files = checked_files(command, context.common);
  command.options.with_elements = !command.outputs.empty() || !context.common.json.empty();
  const SceneFile file =
      read_scene(command.scene, command.materials, context.common.orientation, files);
  return use_prepared(file.scene, mesh_contact_limit(), context.progress,
                      [&](const PreparedScene& prepared) {
                        return run_prepared(command, file, prepared, context);
                      });
}

}  // namespace halfshade
