#pragma once

#include "meshing/backprojection/boundary_chains.h"
#include "meshing/backprojection/emitter_outline.h"
#include "meshing/backprojection/point_view.h"
#include "meshing/backprojection/shadow_arrangement.h"
#include "meshing/backprojection/visible_part.h"

namespace halfshade {

/// The steps of a search for a visible part, on an outline that was made. Keeps its buffers.
struct PartSearch {
  explicit PartSearch(const OpaqueScene& scene) : view(scene) {}

  PointView view;
  EmitterOutline outline;
  ShadowArrangement arrangement;
  BoundaryChains chains;

  enum class End { found, contradictory, crowded };
  End arrange(bool unless_crowded);

  /// What was arranged, without contradictions if that could be had.
  void write(VisiblePart& part);
  /// The outline when something is known to hide all of it.
  void write_hidden(VisiblePart& part);

 private:
  void fill_unobstructed(VisiblePart& part) const;
};

/// Nothing is in front and above the horizon.
void clear(VisiblePart& part);

/// How much the next attempt scatters after one with `jitter` ended in contradictions.
double next_jitter(double jitter);

}  // namespace halfshade
