#pragma once

#include "solver/pipeline/goal_adjoint.h"
#include "solver/pipeline/prepared_scene.h"

#include <cstddef>

namespace halfshade {

/// A solution, as far as a goal is concerned.
struct SolvedFields {
  const ElementTable& elements;
  const ElementField& direct;       ///< on them; not used if it went through the operator
  const ReflectedLight* reflected;  ///< nothing: there is none
};

/// What a solution's mean over a group misses.
struct GoalCorrection {
  Rgb missing = Rgb::Zero();    ///< to be added, W/m²
  Rgb deviation = Rgb::Zero();  ///< its standard deviation
  Rgb moved = Rgb::Zero();      ///< what it is on each element, without signs: z may be off
  std::size_t points = 0;
  bool complete = true;  ///< false if it was stopped
};

/// ∫ z R, R what the solution's irradiance is off from exact direct light and what arrives of light
/// reflected by it (the residual): were z exact, the solution's mean plus this would be exact,
/// whatever the solution is off (Pierce and Giles 2000). What exactly visible parts are gathered
/// from is the solution projected on parts of elements; what that is off counts as well. z and R
/// are gathered at random points, more where z is large, until the standard deviation, its
/// channels' squares summed, is within `deviation` (W/m²), or points are too many. Precondition:
/// light reaches the group.
GoalCorrection correct_goal(const PreparedScene& prepared, const GoalAdjoint& adjoint,
                            const SolvedFields& solved, double deviation, const Progress& progress);

}  // namespace halfshade
