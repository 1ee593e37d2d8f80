#pragma once

#include "apps/commands.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace halfshade {

/// Each adds a subcommand with its options, help and examples; parsing fills `command` and
/// `common`, which must outlive the program.
void add_solve(CLI::App& program, SolveCommand& command, CommonOptions& common);
void add_mesh(CLI::App& program, MeshCommand& command, CommonOptions& common);
void add_render(CLI::App& program, RenderCommand& command, CommonOptions& common);
void add_probe(CLI::App& program, ProbeCommand& command, CommonOptions& common);
void add_factors(CLI::App& program, FactorsCommand& command, CommonOptions& common);
void add_explain(CLI::App& program, ExplainCommand& command, CommonOptions& common);
void add_study(CLI::App& program, StudyCommand& command, CommonOptions& common);

/// What several of them have.
void add_common(CLI::App& app, CommonOptions& common);
void add_scene(CLI::App& app, std::filesystem::path& scene);
void add_materials(CLI::App& app, std::filesystem::path& materials, const char* help);
CLI::Option* add_file(CLI::App& app, const char* name, std::filesystem::path& file,
                      const char* help);
CLI::Option* add_text(CLI::App& app, const char* name, std::string& text, const char* help);
void add_outputs(CLI::App& app, std::vector<std::filesystem::path>& outputs, const char* help);
void add_elements(CLI::App& app, int& elements, const char* help);

/// Which discontinuities to look for.
void add_events(CLI::App& app, DiscontinuityOptions& events, int& secondary);
void add_deviation(CLI::App& app, double& deviation);

/// --flip and --orient, of commands that read a scene; --visibility and --force, of those that
/// solve it or say how.
void add_orientation(CLI::App& app, SceneOptions& options);
void add_visibility(CLI::App& app, SolveOptions& options);
void add_force(CLI::App& app, ForcedStages& force);
/// --method, and --factors with --hemicube and --rays, of solve.
void add_solve_method(CLI::App& app, SolveOptions& options);
/// `saved`, where form factors may also come from a file: the file.
void add_factors_by(CLI::App& app, ExchangeOptions& options,
                    std::filesystem::path* saved = nullptr);

/// --max-elements, of commands that solve a scene or say how.
void add_max_elements(CLI::App& app, int& elements);
/// Once it and --elements are read: where that many are made, the latter may not be more
/// (CLI::ValidationError); if it was not given, it is lowered to that.
void keep_to_limit(const CLI::App& app, SolveOptions& options);
/// Notes --factors, --hemicube, --rays and --visibility where the method leaves them nothing to do.
void note_idle_factors(const CLI::App& app, const SolveOptions& options,
                       std::vector<std::string>& notes);

/// What stands between the commas of lists, also where that is nothing.
std::vector<std::string> items(const std::vector<std::string>& lists);

/// Numbers. Their checks let nothing pass that is not finite, and say so in words of their own.
CLI::Option* add_whole(CLI::App& app, const char* name, int& value, std::array<int, 2> range,
                       const char* help);
/// The same, or the word 'auto', which leaves `value` as it is.
CLI::Option* add_whole_or_auto(CLI::App& app, const char* name, int& value,
                               std::array<int, 2> range, const char* help);
CLI::Option* add_even(CLI::App& app, const char* name, int& value, std::array<int, 2> range,
                      const char* help);
CLI::Option* add_number(CLI::App& app, const char* name, double& value, std::array<double, 2> range,
                        const char* help);
CLI::Option* add_positive(CLI::App& app, const char* name, double& value, const char* help);
CLI::Option* add_not_negative(CLI::App& app, const char* name, double& value, const char* help);
/// Several, separated by commas.
CLI::Option* add_positives(CLI::App& app, const char* name, std::vector<double>& values,
                           const char* help);
/// Two rising numbers, separated by a comma.
CLI::Option* add_range(CLI::App& app, const char* name, std::optional<ValueRange>& value,
                       const char* help);
CLI::Option* add_vector(CLI::App& app, const char* name, std::optional<Vec3>& value,
                        const char* help);

/// One of some words, which `choose` gets the number of.
CLI::Option* add_choice(CLI::App& app, const char* name, const std::vector<std::string>& words,
                        const std::function<void(std::size_t)>& choose, const char* help);

/// One of some words, or else a file with this extension.
CLI::Option* add_choice_or_file(CLI::App& app, const char* name,
                                const std::vector<std::string>& words,
                                const std::function<void(std::size_t)>& choose,
                                const std::string& extension, std::filesystem::path& file,
                                const char* help);

/// Some of some words, separated by commas; `choose` gets for each whether it is given.
CLI::Option* add_words(CLI::App& app, const char* name, const std::vector<std::string>& words,
                       const std::function<void(const std::vector<bool>&)>& choose,
                       const std::string& help);

/// The end of every help text: examples, then the exit codes.
std::string footer(const std::string& text);

}  // namespace halfshade
