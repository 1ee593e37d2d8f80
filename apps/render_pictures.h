#pragma once

#include "apps/commands.h"
#include "io/write/write_report.h"

/// The kinds of pictures that `render` makes.
namespace halfshade {

struct Rendering {
  Picture picture;
  RenderReport report;
};

/// What can be said of the options without looking into a file. Throws Error(usage) for those that
/// have no meaning together.
void require_meaning(const RenderCommand& command);

/// Whether the light is seen by distributed rays.
bool is_distributed(const RenderCommand& command);

/// The camera that the options choose, for a mesh from the input. Throws Error(usage) if there is
/// none of that name or it cannot be used.
Camera chosen_camera(const ShadedMesh& mesh, const RenderCommand& command);

/// The light of a mesh, tone-mapped.
Rendering render_light(const ShadedMesh& mesh, const RenderCommand& command,
                       const Progress& progress);

/// A quantity of a result in false colours.
Rendering render_quantity(const ResultFile& file, const RenderCommand& command,
                          const Progress& progress);

/// One result minus another, alone or beside both.
Rendering render_difference(const ResultFile& one, const ResultFile& other,
                            const RenderCommand& command, const Progress& progress);

}  // namespace halfshade
