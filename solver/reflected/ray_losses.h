#pragma once

#include "meshing/core/progress.h"
#include "solver/reflected/light_systems.h"
#include "solver/reflected/near_backs.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace halfshade {

/// What rays tell of the light that gets lost in open systems.
struct RayLosses {
  /// Element → coefficients of ω, the share of the hemisphere of its places that holds surfaces.
  std::vector<Eigen::VectorXd> seen;
  /// What nodes miss of it, of bright elements; its share is 0 where that may be noise.
  std::vector<std::optional<BackShadow>> shadow;
  /// Element → its form factors to all others may be off by this in the mean: of N rays that all
  /// arrive, up to three in N may get lost (the rule of three, at 95 %), and twice the deviation of
  /// what is known to get lost.
  std::vector<double> unsure;
  std::size_t rays = 0;
};

/// Nodes do not see that light gets out along a slit, or is shaded by a back, where none of them
/// lies. So rays start from places spread over the bright elements of open systems, two halves from
/// each that do not know of each other: with ω as one of them has it and ω′ as the other, and all
/// that arrives taken for even, ∫ ω (ω′ − what nodes tell of ω) less arrives than nodes tell.
/// `told` are the coefficients of that, `cast` how many rays they come from. Until the loss of each
/// system is known to a share `enough` of it, or 2^24 rays are cast. On all threads.
RayLosses find_losses(const ReflectingScene& scene, const FirstLight& light,
                      const ReflectedMesh& mesh, const LightSystems& systems,
                      std::vector<Eigen::VectorXd> told, const std::vector<double>& cast,
                      double enough, const Progress& progress);

}  // namespace halfshade
