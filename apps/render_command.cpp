#include "apps/command_files.h"
#include "apps/console.h"
#include "apps/render_pictures.h"
#include "apps/run_end.h"
#include "apps/traced_pictures.h"
#include "io/picture/radiance_picture.h"
#include "meshing/core/error.h"
#include "meshing/repair/repair.h"

#include <fmt/format.h>

namespace halfshade {
namespace {

constexpr FileFormats render_formats = {"pictures", {".png", ".hdr"}};

CommandFiles checked_files(const RenderCommand& command, const CommonOptions& common) {
  CommandFiles files = has_format(command.input, shaded_formats)
                           ? CommandFiles{{{"INPUT", command.input}}, {{"--json", common.json}}}
                           : scene_files(command.input, command.materials, common);
  files.inputs.push_back({"--curves", command.curves});
  files.inputs.push_back({"--compare", command.compare});
  add_outputs(files, "-o", {command.output});
  require_apart(files);
  require_place(common.json);
  check_output(command.output, render_formats);
  return files;
}

/// Pictures of scenes do without contact lines where there are very many.
constexpr double most_contacts = 60000;

SoundScene sound_for_picture(const Scene& scene) {
  try {
    return make_sound(scene, {.most_contacts = most_contacts});
  } catch (const Error& error) {
    if (error.code() != ErrorCode::too_large) throw;
    return make_sound(scene, {.contacts = false});
  }
}

ShadedMesh load_scene(const RenderCommand& command, const CommandFiles& files,
                      const Context& context) {
  const SceneFile file =
      read_scene(command.input, command.materials, context.common.orientation, files);
  ShadedMesh mesh = shaded(sound_for_picture(file.scene), file.scene.cameras);
  print_warnings(file, {}, context);
  return mesh;
}

void print_rendering(const RenderReport& report, const Context& context) {
  if (report.exposure > 0) fmt::print(context.summary, "exposure     {:.4g}\n", report.exposure);
  if (report.samples > 0)
    fmt::print(context.summary, "rays         {} a pixel, standard error {:.2g} of the light\n",
               report.samples, report.standard_error);
  if (report.quantity.name.empty()) return;
  const std::string unit = report.quantity.unit.empty() ? "" : " " + report.quantity.unit;
  fmt::print(context.summary, "range        {:.4g} to {:.4g}{}\n", report.range.low,
             report.range.high, unit);
  if (report.difference)
    fmt::print(context.summary,
               "difference   {:.3g}{} (root mean square of what is seen), {:.2g} of the other; "
               "largest {:.3g}\n",
               report.difference->rms, unit, report.difference->relative,
               report.difference->largest);
}

ExitCode finish(const RenderCommand& command, const RenderReport& report, const Context& context) {
  if (!context.common.json.empty())
    write_report(report, run_info(context, exit_done, {command.output}), context.common.json);
  if (!context.common.quiet) {
    print_rendering(report, context);
    print_outputs(context, {command.output});
  }
  return exit_done;
}

ExitCode run_radiance(const RenderCommand& command, const Context& context) {
  const ShadedMesh mesh = read_shaded(command.input);
  const Camera camera = chosen_camera(mesh, command);
  const RadiancePicture picture = draw_radiance(mesh, camera, command.options, context.progress);
  context.progress_ends();
  if (context.progress.stopped()) return end_without_results();
  write_hdr(picture, command.output);
  return finish(command, {picture.width, picture.height, 0, camera, {}, {}, {}}, context);
}

TracedRendering traced_scene(const RenderCommand& command, const CommandFiles& files,
                             const Context& context) {
  const SceneFile file =
      read_scene(command.input, command.materials, context.common.orientation, files);
  require_three_channels(file, "render");
  TracedRendering traced =
      render_traced(sound_for_picture(file.scene), file.scene.cameras, command, context.progress);
  context.progress_ends();
  print_warnings(file, {}, context);
  return traced;
}

ExitCode run_traced(const RenderCommand& command, const CommandFiles& files,
                    const Context& context) {
  TracedRendering traced =
      command.method == RenderMethod::drawn
          ? render_distributed(read_shaded(command.input), command, context.progress)
          : traced_scene(command, files, context);
  context.progress_ends();
  if (context.progress.stopped()) return end_without_results();
  if (has_format(command.output, radiance_formats)) {
    write_hdr(traced.radiance, command.output);
  } else {
    const Picture picture = tone_mapped(traced.radiance, traced.emits, command.options.exposure);
    traced.report.exposure = picture.exposure;
    write_png(picture, command.output);
  }
  return finish(command, traced.report, context);
}

Rendering rendered(const RenderCommand& command, const CommandFiles& files,
                   const Context& context) {
  if (!has_format(command.input, shaded_formats))
    return render_light(load_scene(command, files, context), command, context.progress);
  const ResultFile file = read_result(command.input);
  if (!command.compare.empty())
    return render_difference(file, read_result(command.compare), command, context.progress);
  if (!command.quantity.empty()) return render_quantity(file, command, context.progress);
  return render_light(shaded(file), command, context.progress);
}

}  // namespace

ExitCode run(const RenderCommand& command, const Context& context) {
  require_meaning(command);
  const CommandFiles files = checked_files(command, context.common);
  if (command.method != RenderMethod::drawn || is_distributed(command))
    return run_traced(command, files, context);
  if (has_format(command.output, radiance_formats)) return run_radiance(command, context);
  const Rendering rendering = rendered(command, files, context);
  context.progress_ends();
  // A picture does not show what of it is missing.
  if (context.progress.stopped()) return end_without_results();
  write_png(rendering.picture, command.output);
  return finish(command, rendering.report, context);
}

}  // namespace halfshade
