#include "apps/command_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {

void add_common(CLI::App& app, CommonOptions& common) {
  app.add_flag("-q,--quiet", common.quiet, "Print errors only");
  app.add_flag("-v,--verbose", common.verbose, "Print repairs and the time of each stage");
  app.add_option("--threads", common.threads, "Number of threads (default: all of the machine)")
      ->check(CLI::Range(1, 4096));
  add_file(app, "--json", common.json, "Write a machine-readable report to FILE");
}

void add_scene(CLI::App& app, std::filesystem::path& scene) {
  app.add_option("scene", scene, "Scene: .obj, .ply, .off, .gltf, .glb, .stl, …")
      ->required()
      ->type_name("SCENE");
}

void add_materials(CLI::App& app, std::filesystem::path& materials, const char* help) {
  add_file(app, "--materials", materials, help);
}

CLI::Option* add_file(CLI::App& app, const char* name, std::filesystem::path& file,
                      const char* help) {
  return app.add_option(name, file, help)->type_name("FILE");
}

void add_outputs(CLI::App& app, std::vector<std::filesystem::path>& outputs, const char* help) {
  app.add_option("-o,--output", outputs, help)
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_elements(CLI::App& app, int& elements, const char* help) {
  app.add_option("--elements", elements, help)
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
}

void add_events(CLI::App& app, DiscontinuityOptions& events, int& secondary) {
  app.add_option_function<std::vector<std::string>>(
         "--events",
         [&events](const std::vector<std::string>& names) {
           const auto asked = [&](const char* name) {
             return std::find(names.begin(), names.end(), name) != names.end();
           };
           events = {asked("contact"), asked("face"), asked("ev"), asked("eee")};
         },
         "Only curves of these kinds, separated by commas: contact, face, ev, eee (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"contact", "face", "ev", "eee"}))
      ->type_name("KIND,…");
  app.add_option("--secondary", secondary,
                 "Also look for the curves of the N brightest reflecting surfaces")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000000));
}

CLI::Validator number(bool zero_too) {
  return {[zero_too](const std::string& text) -> std::string {
            double value = -1;
            if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) &&
                (value > 0 || (zero_too && value == 0)))
              return {};
            return fmt::format("'{}' is not a number {} zero", text,
                               zero_too ? "of at least" : "above");
          },
          zero_too ? "NUMBER >= 0" : "NUMBER > 0"};
}

std::string footer(const std::string& text) {
  return text +
         "Exit codes: 0 done, 2 wrong usage, 3 invalid input, 4 written, but the radiosity\n"
         "iteration did not reach its tolerance, 5 could not write, 130 interrupted (what was\n"
         "computed so far is written and marked).";
}

}  // namespace halfshade
