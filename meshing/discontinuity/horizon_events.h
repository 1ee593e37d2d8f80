#pragma once

#include "meshing/discontinuity/discontinuity.h"
#include "meshing/discontinuity/event_decision.h"
#include "meshing/events/emitter_scene.h"

#include <cstddef>
#include <vector>

namespace halfshade {

/// Finds the lines in a receiver whose plane cuts the emitter along which two edges that rise over
/// that plane line up with the emitter: one of them may be the emitter's own. Beside them something
/// comes up over the horizon. One a thread.
class HorizonSearch {
 public:
  /// All must outlive the search.
  HorizonSearch(const SoundScene& scene, const OpaqueScene& opaque,
                const EmitterScene& emitter_scene);

  /// Whether the receiver's plane cuts the emitter.
  bool is_cut(int receiver) const;

  /// Appends straight curves of order 3. Ends early and returns false if it takes more than
  /// `most_work`. Cost grows with the square of the number of edges that cut the receiver's plane.
  bool add_curves(int receiver, double most_work, std::vector<DiscontinuityCurve>& curves);

  /// All that was done so far, in units of the search's budget.
  double work() const;

 private:
  /// Where something rises over the receiver's plane.
  struct Post {
    Vec3 position;
    std::vector<EdgeId> edges;
    std::vector<int> silhouettes;  ///< into the emitter scene's edges; none on the emitter
    Feature feature;
    double joined;  ///< things closer than this are meant to be here
  };
  /// Two posts in line, the second behind the first as the light goes.
  struct Alignment {
    const Post *near, *far;
    Vec3 start;  ///< on the emitter
  };

  std::vector<Post> posts_on_emitter(const Surface& receiver) const;
  std::vector<Post> posts_of_scene(const Surface& receiver) const;
  bool may_hide(const Post& post, const Vec3& direction) const;
  bool find_start(const Post& near, const Post& far, Vec3& start) const;
  void add_alignment(int receiver, const Alignment& line, std::vector<DiscontinuityCurve>& curves);

  const SoundScene& scene_;
  const OpaqueTopology& opaque_;
  const EmitterScene& emitter_scene_;
  EventDecider decider_;
  std::size_t tests_ = 0;
};

}  // namespace halfshade
