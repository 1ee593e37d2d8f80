#pragma once

#include "meshing/core/progress.h"
#include "solver/pipeline/field_lookup.h"
#include "solver/pipeline/goal.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve.h"

#include <algorithm>
#include <memory>

namespace halfshade {

/// What adjoint light is solved for to: errors of weights only misplace effort, and what a solution
/// is off moves its goal by no more than this share of it once that is corrected, see correct_goal.
inline constexpr double adjoint_tolerance = 0.05;

/// The light of a scene in which a group alone shines, 1 W/m² in each channel: z × area, see
/// GoalWeights.
class GoalAdjoint {
 public:
  /// Solves for it like for any light, to adjoint_tolerance, by what `options` allow. The scene
  /// must outlive it.
  GoalAdjoint(const SoundScene& scene, int group, const SolveOptions& options,
              const Progress& progress);
  GoalAdjoint(const GoalAdjoint&) = delete;  // the lookup keeps the light's address

  int group() const { return group_; }
  double area() const { return area_; }  ///< of the group, squared scene units
  int elements() const { return light_.elements.count(); }
  /// adjoint_tolerance, or what else was reached.
  double error() const { return std::max(light_.relative_error, adjoint_tolerance); }

  /// What leaves, by polynomials.
  Rgb leaving(int surface, const Vec3& position) const;

  /// What arrives at a point and leaves it.
  struct Importance {
    Rgb arriving = Rgb::Zero(), leaving = Rgb::Zero();
  };
  /// From exact direct light and what is reflected, gathered once more; see ReflectedLight::gather.
  /// Where nothing is reflected, what arrives is left out.
  Importance exactly(int surface, const SurfacePoint& point, int rays) const;

  /// ∫ z of the channel where it is largest.
  double integral() const;

  /// The goal, W/m²: what emitters send to the group is what it would send to them.
  Rgb goal() const;

 private:
  double exitance(int surface) const;
  Rgb rho(int surface, const Vec3& position) const;

  const SoundScene& scene_;
  int group_;
  double area_;
  PreparedScene lit_;
  SolveResult light_;
  FieldLookup irradiance_;  ///< by its polynomials
};

/// The adjoint is kept in them. No weight if no light reaches the group.
GoalWeights weights_of(std::shared_ptr<const GoalAdjoint> adjoint);

}  // namespace halfshade
