#pragma once

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/backprojection/opaque_topology.h"
#include "meshing/events/swath.h"

#include <vector>

namespace halfshade {

/// Finds the surfaces that lines of sight end on. Keeps its buffers between calls; one a thread.
class SightCaster {
 public:
  /// Both must outlive the caster.
  SightCaster(const SoundScene& scene, const OpaqueScene& opaque);

  /// The surfaces that a line may end on after its last feature, if nothing clearly blocks it
  /// before: the first that it clearly passes through, those that lie in the same place, and those
  /// that it only grazes on the way.
  /// Surfaces that turn their back to the emitter are replaced by those on their other side. Each
  /// once, in the order of the line; valid until the next call. Cost grows with the faces whose
  /// boxes the line meets.
  const std::vector<int>& cast(const SightLine& line);

  /// The triangles that the last line clearly passes through before its last feature, which is why
  /// it ends on no surface. Valid until the next call.
  const std::vector<int>& blockers() const { return blockers_; }
  /// How many faces the last line meets.
  std::size_t crossing_count() const { return crossings_.size(); }
  /// How many boxes and faces were looked at for it.
  std::size_t step_count() const { return steps_; }

 private:
  struct Crossing {
    double distance;  ///< along the line, from its last feature
    double slack;     ///< how far off it may be
    int triangle;
    bool is_clear;  ///< well inside the triangle and not along it
  };

  void find_crossings(const SightLine& line);
  void collect_receivers(const SightLine& line);
  bool is_as_near(const Crossing& crossing, const Crossing& before) const;
  void add_receiver(int surface, const Vec3& direction);

  const SoundScene& scene_;
  const OpaqueTopology& opaque_;
  const FlatTree& faces_;
  std::vector<std::vector<int>> backs_;  ///< plane → surfaces that are backs
  std::vector<Crossing> crossings_;
  std::vector<int> reached_, blockers_;
  std::size_t steps_ = 0;
};

}  // namespace halfshade
