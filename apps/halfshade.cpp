#include "apps/command_options.h"
#include "apps/console.h"
#include "apps/interrupt.h"
#include "apps/progress_bar.h"
#include "apps/usage_error.h"
#include "io/files/same_file.h"
#include "meshing/core/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <new>
#include <system_error>
#include <thread>

namespace halfshade {
namespace {

int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return exit_usage;
    case ErrorCode::unwritable:
      return exit_unwritable;
    case ErrorCode::invalid_input:
    case ErrorCode::too_large:
    case ErrorCode::contract:
      break;
  }
  return exit_invalid_input;
}

std::string joined(int argc, char** argv) {
  std::string line;
  for (int k = 0; k < argc; ++k) line += (k ? " " : "") + std::string(argv[k]);
  return line;
}

struct Commands {
  SolveCommand solve;
  MeshCommand mesh;
  RenderCommand render;
  ProbeCommand probe;
  FactorsCommand factors;
  ExplainCommand explain;
  StudyCommand study;
};

/// What a command line asks for.
struct Parsed {
  std::string command;  ///< empty: nothing is to be run
  ExitCode exit_code = exit_done;
};

/// Fills the options of the command that is given; answers --help and mistakes itself.
Parsed parse(int argc, char** argv, Commands& commands, CommonOptions& common) {
  CLI::App program("halfshade: discontinuity meshing and accurate radiosity");
  program.name("halfshade");
  program.set_version_flag("--version", HALFSHADE_VERSION);
  program.require_subcommand(1);
  program.footer(footer("Each command has --help with examples.\n"));
  add_solve(program, commands.solve, common);
  add_mesh(program, commands.mesh, common);
  add_render(program, commands.render, common);
  add_probe(program, commands.probe, common);
  add_factors(program, commands.factors, common);
  add_explain(program, commands.explain, common);
  add_study(program, commands.study, common);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& e) {
    program.exit(e);
    return {};
  } catch (const CLI::ParseError& e) {
    complain("halfshade: {}\n", usage_error(program, e, {argv + 1, argv + argc}));
    return {{}, exit_usage};
  }
  return {program.get_subcommands().front()->get_name()};
}

ExitCode run(const std::string& command, const Commands& commands, const Context& context) {
  if (command == "solve") return run(commands.solve, context);
  if (command == "mesh") return run(commands.mesh, context);
  if (command == "probe") return run(commands.probe, context);
  if (command == "factors") return run(commands.factors, context);
  if (command == "explain") return run(commands.explain, context);
  if (command == "study") return run(commands.study, context);
  return run(commands.render, context);
}

int run_program(int argc, char** argv) {
  Context context;
  Commands commands;
  const Parsed parsed = parse(argc, argv, commands, context.common);
  if (parsed.command.empty()) return parsed.exit_code;
  if (!context.common.quiet)
    for (const std::string& note : context.common.notes) complain("note: {}\n", note);
  const Interrupt interrupt;
  const int hardware = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const tbb::global_control threads(
      tbb::global_control::max_allowed_parallelism,
      static_cast<std::size_t>(context.common.threads > 0 ? context.common.threads : hardware));
  ProgressBar bar(!context.common.quiet);
  context.provenance = {HALFSHADE_VERSION, joined(argc, argv)};
  context.progress = {interrupt.token(), [&bar](std::string_view stage, double fraction) {
                        bar.update(stage, fraction);
                      }};
  context.progress_ends = [&bar] { bar.clear(); };
  if (is_standard_stream(context.common.json) || is_standard_stream(commands.probe.output) ||
      is_standard_stream(commands.solve.values) || is_standard_stream(commands.factors.output))
    context.summary = stderr;
  return run(parsed.command, commands, context);
}

/// What is still in the buffer may not find its way out; nor may what was printed before.
int with_output_written(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  complain("halfshade: the standard output cannot be written ({})\n",
           std::generic_category().message(errno));
  return exit_unwritable;
}

/// Runs the program; whatever is thrown becomes a sentence and an exit code.
int guarded(int argc, char** argv) {
  try {
    return with_output_written(run_program(argc, argv));
  } catch (const Error& e) {
    complain("halfshade: {}\n", e.what());
    return exit_code(e.code());
  } catch (const std::bad_alloc&) {
    complain("halfshade: the machine has not enough memory for this; ask for fewer elements\n");
    return exit_invalid_input;
  } catch (const std::exception& e) {
    if (const int code = with_output_written(exit_done); code != exit_done) return code;
    complain("halfshade: {}\n", e.what());
    return exit_invalid_input;
  }
}

}  // namespace
}  // namespace halfshade

int main(int argc, char** argv) {
  halfshade::let_writes_fail();
  return halfshade::guarded(argc, argv);
}
