#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/geometry/flat_tree.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/prepared_scene.h"

#include <span>
#include <vector>

namespace halfshade {

/// Of its outer boundary, in space.
Bounds outline_bounds(const Surface& surface);

/// Finds the surfaces that points lie on, up to what rounding leaves of both: a millionth of the
/// surface's size or of its coordinates. Normals may be turned as those of elements are between
/// corners that lie off the surface, by a twentieth of a radian.
class SurfaceFinder {
 public:
  /// The scene must outlive it. Cost: n log n.
  explicit SurfaceFinder(const SoundScene& scene);

  /// The nearest, with a normal like the point's; −1 if the point lies on none. Of several surfaces
  /// in one plane a point belongs to the one whose polygon it lies in.
  int at_point(const SurfacePoint& point) const;

 private:
  const SoundScene& scene_;
  FlatTree boxes_;
};

/// The points with the surfaces they lie on. Those that rounding puts behind their surface, or not
/// before all corners that it shares with others, are moved into its plane: it would hide all light
/// from them.
std::vector<FieldPoint> on_surfaces(const PreparedScene& prepared,
                                    std::span<const SurfacePoint> points);

}  // namespace halfshade
