#pragma once

#include "meshing/backprojection/silhouette_trees.h"
#include "meshing/events/emitter_scene.h"

#include <vector>

namespace halfshade {

/// Finds the parameters at which a swath must be cut, so that nothing changes along its lines
/// between two of them.
class SwathCuts {
 public:
  /// All must outlive the cuts.
  SwathCuts(const SoundScene& scene, const OpaqueScene& opaque, const EmitterScene& emitter_scene);

  /// Where the lines begin and end, pass the emitter's outline, or run along a face of an edge that
  /// makes them; 0 and 1 among them. Sorted; may repeat.
  std::vector<double> limits(const Swath& swath) const;

  /// Where the lines between two neighbouring limits t0 < t1 meet the edges of the scene and the
  /// lines in which surfaces cut each other; t0 and t1 among them. Sorted; may repeat. Perhaps some
  /// at which nothing is met. Costs a walk through the trees of edges, a few times; returns of how
  /// many steps.
  std::size_t between(const Swath& swath, double t0, double t1, std::vector<double>& cuts) const;

  /// The parameters around t, between two neighbouring limits t0 < t1, whose lines pass through a
  /// triangle before the last of their features, as that of t clearly does. Empty if the triangle
  /// is not wholly in front of the emitter.
  struct Stretch {
    double from, to;
    double length() const { return to - from; }
  };
  Stretch hidden_by(int triangle, const Swath& swath, double t, double t0, double t1) const;

 private:
  Span3 span_of(int edge) const;
  void add_grazing(const Swath& swath, std::vector<double>& parameters) const;
  std::size_t add_met(const Swath& swath, double t0, double t1, std::vector<double>& cuts) const;

  const OpaqueTopology& opaque_;
  const SilhouetteTrees& silhouette_trees_;
  const EmitterScene& emitter_scene_;
  std::vector<bool> is_inner_;  ///< edges between two triangles of one surface
  struct Contact {
    Span3 span;
    double joined;  ///< what is closer to it than this is meant to lie on it
  };
  std::vector<Contact> contacts_;  ///< of all surfaces
  FlatTree contact_tree_;          ///< over them
};

}  // namespace halfshade
