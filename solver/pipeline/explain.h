#pragma once

#include "meshing/core/progress.h"
#include "solver/pipeline/plan.h"

#include <cstddef>
#include <string>
#include <vector>

namespace halfshade {

/// A stage of solve before it runs.
struct PlannedStage {
  std::string name;              ///< as in StageReport
  std::string left_out_because;  ///< empty if it will run
  std::string force;             ///< what --force runs it all the same; empty: nothing does
  double amount = 0;             ///< about how much of `what` there is to do
  std::string what;
  double seconds = 0;  ///< about, on two cores; 0 where there is no telling before
  std::string how{};   ///< it will run; empty where there is one way
};

/// A part of space whose surfaces exchange no light with those elsewhere.
struct SpacePart {
  std::vector<std::string> groups;
  double area = 0;
  bool closed = false;
  bool lit = false;
  std::string swallowing;  ///< group whose backs light can get to there; empty if none
};

/// What a scene is and what solve would do with it.
struct Explanation {
  SoundScene scene;
  std::string unit;
  std::vector<Warning> warnings;
  Plan plan;
  std::vector<PlannedStage> stages;
  std::vector<SpacePart> parts;  ///< those that fronts look into
};

/// Of a scene without an emitter, too: then no stage runs. Cost: that of make_plan, and of a mesh
/// of about 2000 elements.
Explanation explain(const PreparedScene& prepared, const SolveOptions& options,
                    const Progress& progress = {});

}  // namespace halfshade
