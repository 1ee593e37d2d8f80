#pragma once

#include "meshing/core/progress.h"
#include "solver/reflected/balance_estimate.h"
#include "solver/reflected/near_backs.h"
#include "solver/reflected/reflected_system.h"
#include "solver/reflected/reflecting_scene.h"

#include <optional>
#include <vector>

namespace halfshade {

/// What is not known of the light that elements lose through gaps narrower than half of what they
/// are long: it gets out within a few times the gap's width of the border, where nodes hardly ever
/// lie, and what these see is taken for the mean. The mean form factor to the surface opposite is
/// known in closed form (mutual_area), to about 1e-7; what nodes miss of it gets lost unseen. Of
/// backs that swallow light close before elements (NearBacks), and of slits, what the exchange does
/// not put right. And what its rays are too few for.
class UnsureLosses {
 public:
  /// The scene must outlive it.
  explicit UnsureLosses(const ReflectingScene& scene) : scene_(scene), backs_(scene) {}

  /// Element → its loss, as well as suits a relative error of light. What gaps and backs before
  /// them take from elements that stay from round to round is found once. If stopped, the rest is
  /// zero.
  std::vector<UnsureLoss> find(const ReflectedSystem& system, double tolerance,
                               const Progress& progress);

 private:
  struct KeptLoss {
    int order = -1;  ///< of the element; −1: none yet
    UnsureLoss in_gaps;
    std::optional<BackShadow> shadow;
  };

  const ReflectingScene& scene_;
  NearBacks backs_;
  std::vector<KeptLoss> of_triangle_;
};

}  // namespace halfshade
