#include "apps/command_options.h"
#include "apps/interrupt.h"
#include "apps/progress_bar.h"
#include "meshing/core/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <new>
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

int run_program(int argc, char** argv) {
  CLI::App program("halfshade: discontinuity meshing and accurate radiosity");
  program.name("halfshade");
  program.set_version_flag("--version", HALFSHADE_VERSION);
  program.require_subcommand(1);
  program.footer(footer("Each command has --help with examples.\n"));
  Context context;
  SolveCommand solve_command;
  MeshCommand mesh_command;
  RenderCommand render_command;
  ProbeCommand probe_command;
  ExplainCommand explain_command;
  add_solve(program, solve_command, context.common);
  add_mesh(program, mesh_command, context.common);
  add_render(program, render_command, context.common);
  add_probe(program, probe_command, context.common);
  add_explain(program, explain_command, context.common);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return program.exit(e) == 0 ? exit_done : exit_usage;
  }
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
  if (program.got_subcommand("solve")) return run(solve_command, context);
  if (program.got_subcommand("mesh")) return run(mesh_command, context);
  if (program.got_subcommand("probe")) return run(probe_command, context);
  if (program.got_subcommand("explain")) return run(explain_command, context);
  return run(render_command, context);
}

}  // namespace
}  // namespace halfshade

int main(int argc, char** argv) {
  try {
    return halfshade::run_program(argc, argv);
  } catch (const halfshade::Error& e) {
    fmt::print(stderr, "halfshade: {}\n", e.what());
    return halfshade::exit_code(e.code());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr,
               "halfshade: the machine has not enough memory for this; ask for fewer elements\n");
    return halfshade::exit_invalid_input;
  } catch (const std::exception& e) {
    fmt::print(stderr, "halfshade: {}\n", e.what());
    return halfshade::exit_invalid_input;
  }
}
