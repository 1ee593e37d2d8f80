#pragma once

#include "meshing/core/progress.h"
#include "solver/pipeline/goal.h"

#include <memory>

namespace halfshade {

struct SolveOptions;

/// Exact parts among few surfaces, if nothing else is asked for: what shines in adjoint light is
/// small, and rays that find it are few; and noise of rays does not average out over the few
/// elements that a goal takes.
ReflectedVisibility visibility_for_goal(const SoundScene& scene, ReflectedVisibility asked);

/// The light of a scene in which a group alone shines, 1 W/m² in each channel: z × area, see
/// GoalWeights. The scene it was made for must outlive it.
struct GoalAdjoint {
  const SoundScene& scene;
  int group;
  double area;           ///< of the group, squared scene units
  ReflectedLight light;  ///< all irradiance there

  /// ρ of a surface.
  Rgb rho(int surface, const Vec3& position) const;

  /// What leaves, by polynomials.
  Rgb leaving(int surface, const Vec3& position) const;

  /// The same gathered by rays or exactly visible parts, see ReflectedLight::gather.
  Rgb leaving_exactly(int surface, const SurfacePoint& point, int rays) const;

  /// ∫ z of the channel where it is largest.
  double integral() const;

  /// The goal, W/m²: what emitters send to the group is what it would send to them.
  Rgb goal() const;
};

/// Solves for it to a fortieth, as `options` say of visibility and bounces.
GoalAdjoint solve_adjoint(const SoundScene& scene, int group, const SolveOptions& options,
                          const Progress& progress);

/// The adjoint is kept in them. No weight if no light reaches the group.
GoalWeights weights_of(std::shared_ptr<const GoalAdjoint> adjoint);

}  // namespace halfshade
