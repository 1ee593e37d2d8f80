#pragma once

#include "solver/reflected/direct_projection.h"
#include "solver/reflected/irradiance_row.h"

namespace halfshade {

/// What leaves elements, on parts of them: each is cut in four, and direct light is projected on
/// the quarters, so that what a solution's own elements are off shows, or is put right.
class ExactGather {
 public:
  /// `leaving` is what leaves the elements of the mesh without S. `sight`, `scene` and `light` must
  /// outlive it. Asks for direct light at about `direct_points` points.
  ExactGather(const ExactSight& sight, const ReflectingScene& scene, const FirstLight& light,
              const ReflectedMesh& mesh, const ElementField& leaving, const RowAccuracy& accuracy,
              int direct_points);

  struct Gathered {
    Rgb irradiance;  ///< from S and what else leaves
    double reach;    ///< form factor to all that is seen
    double unsure;   ///< see IrradianceRow
  };
  /// At a position in a part of a root.
  Gathered gather(int root, const Vec3& position, std::span<const Sighted> targets) const;

  /// The most that leaves any triangle in the mean.
  const Rgb& brightest() const { return brightest_; }

  /// What leaves a place of a surface, as it stands for what does.
  Rgb leaving(int surface, const Vec3& position) const;

  /// At any point, of which nothing is known.
  Rgb irradiance(const SurfacePoint& point) const;

 private:
  const ExactSight& sight_;
  const ReflectingScene& scene_;
  ReflectedMesh mesh_;
  Rgb brightest_ = Rgb::Zero();
  QuickField leaving_;
  RowMaker maker_;
};

}  // namespace halfshade
