#include "apps/command_options.h"

#include "io/files/extension.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace halfshade {
namespace {

CLI::Validator not_empty() {
  return {[](const std::string& text) {
            return text.empty() ? std::string("the name is empty") : std::string();
          },
          ""};
}

/// Which of some words this is, whatever its letters' case; their number if it is none.
std::size_t place_of(const std::string& word, const std::vector<std::string>& words) {
  const auto found = std::find(words.begin(), words.end(), CLI::detail::to_lower(word));
  return static_cast<std::size_t>(found - words.begin());
}

}  // namespace

std::vector<std::string> items(const std::vector<std::string>& lists) {
  std::vector<std::string> result;
  for (const std::string& list : lists) {
    std::size_t from = 0, comma = 0;
    do {
      comma = std::min(list.find(',', from), list.size());
      result.push_back(list.substr(from, comma - from));
      from = comma + 1;
    } while (comma < list.size());
  }
  return result;
}

void add_common(CLI::App& app, CommonOptions& common) {
  app.add_flag("-q,--quiet", common.quiet, "Print errors only");
  app.add_flag("-v,--verbose", common.verbose, "Print repairs and the time of each stage");
  add_whole(app, "--threads", common.threads, {1, 4096},
            "Number of threads (default: all of the machine)");
  add_file(app, "--json", common.json, "Write a machine-readable report to FILE; '-': to stdout");
}

void add_scene(CLI::App& app, std::filesystem::path& scene) {
  app.add_option("scene", scene, "Scene: .obj, .ply, .off, .gltf, .glb, .stl, .vs3, .msh, …")
      ->required()
      ->check(not_empty())
      ->type_name("SCENE");
}

void add_materials(CLI::App& app, std::filesystem::path& materials, const char* help) {
  add_file(app, "--materials", materials, help);
}

CLI::Option* add_file(CLI::App& app, const char* name, std::filesystem::path& file,
                      const char* help) {
  return app.add_option(name, file, help)->check(not_empty())->type_name("FILE");
}

CLI::Option* add_text(CLI::App& app, const char* name, std::string& text, const char* help) {
  return app.add_option(name, text, help)->check(not_empty())->type_name("NAME");
}

void add_outputs(CLI::App& app, std::vector<std::filesystem::path>& outputs, const char* help) {
  app.add_option("-o,--output", outputs, help)
      ->type_name("FILE")
      ->check(not_empty())
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_elements(CLI::App& app, int& elements, const char* help) {
  add_whole(app, "--elements", elements, {1, 1000000}, help)->capture_default_str();
}

CLI::Option* add_words(CLI::App& app, const char* name, const std::vector<std::string>& words,
                       const std::function<void(const std::vector<bool>&)>& choose,
                       const std::string& help) {
  const auto check = [words](std::string& list) {
    for (const std::string& item : items({list}))
      if (std::find(words.begin(), words.end(), item) == words.end())
        return fmt::format("'{}' is none of {}", item, fmt::join(words, ", "));
    return std::string();
  };
  return app
      .add_option_function<std::vector<std::string>>(
          name,
          [words, choose](const std::vector<std::string>& lists) {
            const std::vector<std::string> given = items(lists);
            std::vector<bool> asked;
            for (const std::string& word : words)
              asked.push_back(std::find(given.begin(), given.end(), word) != given.end());
            choose(asked);
          },
          help)
      ->check(CLI::Validator(check, ""))
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_events(CLI::App& app, DiscontinuityOptions& events, int& secondary) {
  add_words(
      app, "--events", {"contact", "face", "ev", "eee", "horizon"},
      [&events](const std::vector<bool>& asked) {
        events = {asked[0], asked[1], asked[2], asked[3], asked[4]};
      },
      "Only curves of these kinds, separated by commas: contact, face, ev, eee and, in complete\n"
      "meshes, horizon (default: all)")
      ->type_name("KIND,…");
  add_whole(app, "--secondary", secondary, {0, 1000000},
            "Also look for the curves of the N brightest reflecting surfaces")
      ->capture_default_str();
}

void add_deviation(CLI::App& app, double& deviation) {
  add_number(app, "--deviation", deviation, {1e-9, 0.1},
             "How far mesh edges may be off curved discontinuities, as a share of the surface\n"
             "(default: what the tolerance allows, 1e-4 without one)");
}

CLI::Option* add_choice(CLI::App& app, const char* name, const std::vector<std::string>& words,
                        const std::function<void(std::size_t)>& choose, const char* help) {
  const CLI::Validator is_known(
      [words](std::string& word) {
        return place_of(word, words) < words.size()
                   ? std::string()
                   : fmt::format("'{}' is not one of {}", word, fmt::join(words, ", "));
      },
      "");
  return app
      .add_option_function<std::string>(
          name, [words, choose](const std::string& word) { choose(place_of(word, words)); }, help)
      ->check(is_known)
      ->default_str(words.front())
      ->type_name(fmt::format("{}", fmt::join(words, "|")));
}

CLI::Option* add_choice_or_file(CLI::App& app, const char* name,
                                const std::vector<std::string>& words,
                                const std::function<void(std::size_t)>& choose,
                                const std::string& extension, std::filesystem::path& file,
                                const char* help) {
  const auto is_file = [extension](const std::string& word) {
    return extension_of(word) == extension;
  };
  const CLI::Validator is_known(
      [words, is_file, extension](std::string& word) {
        return is_file(word) || place_of(word, words) < words.size()
                   ? std::string()
                   : fmt::format("'{}' is not one of {}, and no file {}", word,
                                 fmt::join(words, ", "), extension);
      },
      "");
  const auto take = [words, choose, is_file, &file](const std::string& word) {
    if (is_file(word))
      file = word;
    else
      choose(place_of(word, words));
  };
  return app.add_option_function<std::string>(name, take, help)
      ->check(is_known)
      ->default_str(words.front())
      ->type_name(fmt::format("{}|FILE{}", fmt::join(words, "|"), extension));
}

std::string footer(const std::string& text) {
  return text +
         "Exit codes: 0 done, 2 wrong usage, 3 invalid input, 4 written, but not as\n"
         "exact as was asked for, 5 could not write, 130 interrupted (what was computed so far\n"
         "is written and marked).";
}

}  // namespace halfshade
