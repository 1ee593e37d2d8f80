#pragma once

#include "apps/commands.h"
#include "io/read/read_scene.h"
#include "io/write/write_report.h"
#include "meshing/core/sound_scene.h"
#include "solver/pipeline/warnings.h"

#include <filesystem>
#include <span>
#include <vector>

/// What all commands end with.
namespace halfshade {

/// Prints what of a scene's files was not used, or guessed, and what to doubt of a result.
void print_warnings(const SceneFile& file, std::span<const Warning> of_result,
                    const Context& context);

/// The first of that, for reports: what was printed already.
std::vector<Warning> warnings_of(const SceneFile& file);

/// Prints what was put right in a scene, if more than the summary is to be told.
void print_repairs(const SoundScene& scene, const Context& context);

/// What the report says of the run so far.
RunInfo run_info(const Context& context, ExitCode code,
                 const std::vector<std::filesystem::path>& outputs);

/// Prints where the results are.
void print_outputs(const Context& context, const std::vector<std::filesystem::path>& outputs);

/// For runs that were interrupted before they had anything to show: files of earlier runs are worth
/// more than empty ones.
ExitCode end_without_results();

}  // namespace halfshade
