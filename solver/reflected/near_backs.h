#pragma once

#include "meshing/geometry/flat_tree.h"
#include "solver/reflected/reflected_mesh.h"
#include "solver/reflected/reflecting_scene.h"

#include <array>
#include <vector>

namespace halfshade {

/// Where surfaces reflect more than this, what gets lost is looked for.
inline constexpr double bright = 0.9;

/// As many looks as are worth it where what backs hide is put right.
inline constexpr double looks_to_put_right = 1e5;

/// What an element's nodes miss of how backs close before it, or slits along its edges, darken it.
struct BackShadow {
  /// Adds what is missing to the mean, such that what of it gets out is right: a share of what
  /// arrives at each node. Empty if no back is near.
  Eigen::RowVectorXd of_nodes;
  double share = 0;   ///< the same as a share of what arrives in the mean, with its sign
  double unsure = 1;  ///< which part of that is not known
  double height = 0;  ///< of the element above the back, or how far a slit reaches into it
};

/// A back close before an element.
struct NearBack {
  std::array<Vec3, 3> corners;  ///< counter-clockwise seen from behind
  double rise = 0;              ///< how far it gets before the element's plane
};

/// Backs that swallow light close before elements. Light changes within some gaps' width of their
/// borders, where nodes hardly ever lie, and as much as comes in there gets lost.
class NearBacks {
 public:
  /// The scene must outlive it. Cost: n log n.
  explicit NearBacks(const ReflectingScene& scene);

  /// With what an element sees of backs in closed form, as if all else that arrives were even and
  /// nothing came between: ω = 1 − F of what leaves a place gets out, and as much arrives there.
  /// Nodes take π for ω, so that ∫ ω (ω − π) too little gets out. Of splinters all counts as
  /// missed, and past very many backs what might be in parts that are left too large: the element
  /// is cut into parts, those first in which most changes, until so many backs hide something of
  /// `most_looks` of them in all.
  BackShadow shadow(const ReflectedMesh& mesh, int element, double most_looks) const;

 private:
  struct Near {
    std::vector<NearBack> backs;
    double height = 0;  ///< of the element's lowest corner above one of them
  };
  Near near(const ReflectedMesh& mesh, int element) const;

  const ReflectingScene& scene_;
  std::vector<int> backs_;  ///< roots whose backs swallow light
  FlatTree boxes_;          ///< of them
};

}  // namespace halfshade
