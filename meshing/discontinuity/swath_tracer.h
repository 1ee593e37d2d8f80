#pragma once

#include "meshing/discontinuity/discontinuity.h"
#include "meshing/discontinuity/event_culling.h"
#include "meshing/discontinuity/event_decision.h"
#include "meshing/discontinuity/known_pieces.h"
#include "meshing/discontinuity/sight_casting.h"
#include "meshing/discontinuity/swath_cuts.h"
#include "meshing/events/emitter_scene.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace halfshade {

/// Counts of what a tracer did.
struct TraceCounts {
  std::size_t swaths = 0;
  std::size_t pieces = 0;
  std::size_t steps = 0;      ///< boxes, edges and faces looked at
  std::size_t crossings = 0;  ///< faces met by lines of sight
  SightEffort effort;         ///< of deciding
};

TraceCounts operator-(const TraceCounts& a, const TraceCounts& b);
TraceCounts& operator+=(TraceCounts& a, const TraceCounts& b);

/// Follows swaths of lines to the surfaces they end on and finds the pieces of curve they make
/// there. Where one face hides the emitter all along a stretch of the swath, that is passed over;
/// the rest is cut wherever its line meets an edge of the scene. Between two such lines nothing
/// changes, and one line decides: it must reach the emitter unblocked, and what is seen of
/// the edges that make the swath must differ on the two sides of the curve. The latter is decided
/// by VisiblePartFinder. One a thread.
class SwathTracer {
 public:
  /// All must outlive the tracer.
  SwathTracer(const SoundScene& scene, const OpaqueScene& opaque, const EmitterScene& emitter_scene,
              const TraceLimits& limits = {});

  /// Forgets what earlier swaths made: what is traced next depends on nothing before.
  void begin() { known_ = {}; }

  /// Appends the pieces of curve that a swath makes. Ends early and returns false as soon as
  /// `may_go_on`, if given, does, which is asked before each piece of the swath.
  bool trace(const Swath& swath, std::vector<DiscontinuityCurve>& curves,
             const std::function<bool()>& may_go_on = {});

  const TraceCounts& counts() const { return counts_; }
  const EmitterScene& emitter_scene() const { return emitter_scene_; }

 private:
  /// A piece of curve on a receiver.
  struct Piece {
    int receiver;
    double t0, t1;
    double step;  ///< see side_step
    std::vector<EdgeTriple> triples;
  };

  bool trace_between(const Swath& swath, double t0, double t1, int divisions,
                     const std::function<bool()>& may_go_on);
  SwathCuts::Stretch hidden_around(const Swath& swath, double t, double t0, double t1);
  void trace_piece(const Swath& swath, double t0, double t1);
  void try_receiver(const Swath& swath, const SightLine& line, int receiver, double t0, double t1);
  void add_piece(Piece piece);
  void append_curves(const Swath& swath, const Piece& piece,
                     std::vector<DiscontinuityCurve>& curves) const;

  const SoundScene& scene_;
  const EmitterScene& emitter_scene_;
  SwathCuts cuts_;
  SightCaster caster_;
  EventCulling culling_;
  EventDecider decider_;
  std::vector<double> parameters_;
  std::vector<Piece> pieces_;  ///< of the swath that is being traced
  KnownPieces known_;
  TraceCounts counts_;
};

}  // namespace halfshade
