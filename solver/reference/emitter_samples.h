#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/rays/occluders.h"

#include <optional>
#include <vector>

namespace halfshade {

/// A random point of the emitters.
struct EmitterPoint {
  Vec3 position;
  int surface = 0;
  double density = 0;  ///< probability per area, > 0
};

/// Random points of all that emits: surfaces by their power, evenly over each.
class EmitterSamples {
 public:
  /// `soup` has the scene's surfaces, owner = surface, backs included. Both must outlive it.
  EmitterSamples(const SoundScene& scene, const TriangleSoup& soup);

  /// Nothing if nothing emits. Numbers in [0, 1) that are spread evenly give points that are.
  std::optional<EmitterPoint> point(const Vec2& numbers) const;

  /// The density at points of a surface; 0 if it does not emit.
  double density(int surface) const;

 private:
  const SoundScene& scene_;
  const TriangleSoup& soup_;
  std::vector<int> triangles_;     ///< of the soup, that emit
  std::vector<double> power_sum_;  ///< of a triangle and those before it
};

}  // namespace halfshade
