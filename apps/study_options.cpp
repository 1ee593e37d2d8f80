#include "apps/command_options.h"
#include "io/study/study_methods.h"

#include <CLI/CLI.hpp>

namespace halfshade {
namespace {

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const StudyMethod& method : study_methods()) names.emplace_back(method.name);
  return names;
}

std::string method_help() {
  std::string help = "Methods, separated by commas (default: the first six):";
  for (const StudyMethod& method : study_methods())
    (((help += "\n") += method.name) += ": ") += method.what;
  return help;
}

}  // namespace

void add_study(CLI::App& program, StudyCommand& command, CommonOptions& common) {
  CLI::App& app = *program.add_subcommand(
      "study", "Measure what accuracy costs in a scene, with each of several methods");
  add_scene(app, command.scene);
  app.add_option("-o,--output", command.options.folder,
                 "Folder for study.csv, study.html and charts; a study in it goes on")
      ->required()
      ->type_name("FOLDER");
  add_words(
      app, "--methods", method_names(),
      [&command](const std::vector<bool>& asked) {
        for (std::size_t k = 0; k < asked.size(); ++k)
          if (asked[k]) command.options.methods.push_back(method_names()[k]);
      },
      method_help())
      ->type_name("METHOD,…");
  add_positives(
      app, "--tolerances", command.options.tolerances,
      "Tolerances, separated by commas (default: 0.1,0.03,0.01,0.003,0.001,0.0003,0.0001)");
  add_positive(app, "--time-limit", command.options.time_limit,
               "Seconds that a case may take; after one that takes longer, its method's finer\n"
               "ones are left out")
      ->capture_default_str();
  app.add_flag("--direct", command.options.reference.direct_only,
               "Only light straight from the emitters");
  add_whole(app, "--points", command.options.reference.points, {1, 1000000},
            "Points at which errors are measured, spread over all surfaces")
      ->capture_default_str();
  add_whole(app, "--samples", command.options.reference.samples, {1, 1000000000},
            "Random walks from each, for what reflected light is right")
      ->capture_default_str();
  add_materials(app, command.materials, "Materials file, as for solve");
  add_orientation(app, common.orientation);
  add_common(app, common);
  app.footer(footer(
      "Cases are runs of their own, so that their memory and time are measured, and can be cut\n"
      "short. Interrupted, the study goes on where it was when it is started again.\n\n"
      "Examples:\n"
      "  halfshade study data/s1.obj -o s1_study --direct --tolerances 0.1,0.03\n"
      "  halfshade study data/bars.obj -o bars_study --methods fields,matrix --tolerances 0.1 "
      "--points 100 "
      "--time-limit 30\n\n"));
}

}  // namespace halfshade
