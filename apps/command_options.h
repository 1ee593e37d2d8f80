#pragma once

#include "apps/commands.h"

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace halfshade {

/// Each adds a subcommand with its options, help and examples; parsing fills `command` and
/// `common`, which must outlive the program.
void add_solve(CLI::App& program, SolveCommand& command, CommonOptions& common);
void add_mesh(CLI::App& program, MeshCommand& command, CommonOptions& common);
void add_render(CLI::App& program, RenderCommand& command, CommonOptions& common);
void add_probe(CLI::App& program, ProbeCommand& command, CommonOptions& common);
void add_explain(CLI::App& program, ExplainCommand& command, CommonOptions& common);

/// What several of them have.
void add_common(CLI::App& app, CommonOptions& common);
void add_scene(CLI::App& app, std::filesystem::path& scene);
void add_materials(CLI::App& app, std::filesystem::path& materials, const char* help);
CLI::Option* add_file(CLI::App& app, const char* name, std::filesystem::path& file,
                      const char* help);
void add_outputs(CLI::App& app, std::vector<std::filesystem::path>& outputs, const char* help);
void add_elements(CLI::App& app, int& elements, const char* help);

/// Which discontinuities to look for.
void add_events(CLI::App& app, DiscontinuityOptions& events, int& secondary);

/// A number that is finite and at least zero, or above it; CLI11's own checks let NaN pass.
CLI::Validator number(bool zero_too);

/// The end of every help text: examples, then the exit codes.
std::string footer(const std::string& text);

}  // namespace halfshade
