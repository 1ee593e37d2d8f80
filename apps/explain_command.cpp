#include "apps/command_files.h"
#include "apps/run_end.h"
#include "io/write/write_explanation.h"
#include "meshing/repair/repair_sentence.h"
#include "solver/pipeline/limits.h"
#include "solver/pipeline/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>

namespace halfshade {
namespace {

/// The first of each kind, unless all are asked for: a modelled figure is joined in hundreds of
/// places.
void print_some_repairs(const SoundScene& scene, bool all, std::FILE* out) {
  constexpr std::size_t most = 5;
  std::map<Repair::Kind, std::size_t> count;
  for (const Repair& repair : scene.repairs)
    if (++count[repair.kind] <= most || all)
      fmt::print(out, "repair       {}\n", sentence(repair, scene));
  for (const auto& [kind, n] : count)
    if (n > most && !all)
      fmt::print(out, "repairs      {} more like these ({}); --verbose lists them\n", n - most,
                 name_of(kind));
}

void print_scene(const Explanation& explanation, bool all_repairs, std::FILE* out) {
  const SoundScene& scene = explanation.scene;
  fmt::print(out, "surfaces     {} of {} faces, {} group{}, {} material{}\n", scene.surfaces.size(),
             scene.face_lines.size(), scene.groups.size(), scene.groups.size() == 1 ? "" : "s",
             scene.materials.size(), scene.materials.size() == 1 ? "" : "s");
  print_some_repairs(scene, all_repairs, out);
  // Of a scene that nothing lights, all parts are of interest, and of others those that are lit.
  const auto& parts = explanation.parts;
  const bool any_lit =
      std::any_of(parts.begin(), parts.end(), [](const SpacePart& part) { return part.lit; });
  std::size_t unlit = 0;
  for (const SpacePart& part : parts) {
    if (any_lit && !part.lit) ++unlit;
    if (any_lit && !part.lit) continue;
    constexpr std::size_t most_names = 6;
    const std::size_t shown = std::min(most_names, part.groups.size());
    fmt::print(out, "part         {}: {}{}{}\n", part.closed ? "closed" : "open",
               fmt::join(part.groups.begin(),
                         part.groups.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
               shown < part.groups.size() ? ", …" : "",
               part.swallowing.empty()
                   ? ""
                   : fmt::format("; light reaches the back of {}", part.swallowing));
  }
  if (unlit > 0) fmt::print(out, "parts        {} more without a light, as inside solids\n", unlit);
}

void print_stages(const Explanation& explanation, std::FILE* out) {
  for (const PlannedStage& stage : explanation.stages) {
    std::string line = stage.left_out_because.empty()
                           ? fmt::format("runs         {}", stage.name)
                           : fmt::format("left out     {}: {}", stage.name, stage.left_out_because);
    if (!stage.left_out_because.empty() && !stage.force.empty())
      line += fmt::format(" (--force {})", stage.force);
    if (!stage.how.empty()) line += ", " + stage.how;
    if (stage.left_out_because.empty() && stage.amount > 0)
      line += fmt::format(": {:.3g} {}", stage.amount, stage.what);
    if (stage.left_out_because.empty() && stage.seconds > 0)
      line += stage.seconds < 10 ? fmt::format(", {:.2g} s or more", stage.seconds)
                                 : fmt::format(", {:.0f} s or more", stage.seconds);
    fmt::print(out, "{}\n", line);
  }
}

}  // namespace

ExitCode run(const ExplainCommand& command, const Context& context) {
  const CommandFiles files = scene_files(command.scene, command.materials, context.common);
  require_apart(files);
  require_place(context.common.json);
  const SceneFile file = read_scene(command.scene, command.materials, context.common.orientation,
                                    files, command.options.tolerance);
  const SolveOptions options = with_limits(command.options, file.scene.faces.size());
  const ContactLimit limit{static_cast<double>(options.max_elements),
                           contacts_warning(options.max_elements)};
  Explanation explanation = use_prepared(
      file.scene, limit, context.progress,
      [&](const PreparedScene& prepared) { return explain(prepared, options, context.progress); },
      Emitters::optional);
  context.progress_ends();
  const ExitCode code = context.progress.stopped() ? exit_interrupted : exit_done;
  print_warnings(file, explanation.warnings, context);
  add(warnings_of(file), explanation.warnings);
  if (!context.common.json.empty())
    write_explanation(explanation, run_info(context, code, {}), context.common.json);
  if (!context.common.quiet) {
    print_scene(explanation, context.common.verbose, context.summary);
    print_stages(explanation, context.summary);
  }
  return code;
}

}  // namespace halfshade
