#pragma once

#include "meshing/backprojection/silhouette_trees.h"
#include "meshing/backprojection/visible_part.h"
#include "meshing/discontinuity/discontinuity.h"
#include "meshing/discontinuity/event_jump.h"
#include "meshing/events/emitter_stage.h"

#include <cstddef>
#include <vector>

namespace halfshade {

/// What is not worth following.
struct TraceLimits {
  double least_change = 0;  ///< of the form factor over an element
  double max_length = 0;    ///< see element_size
};

/// Counts of what a tracer did.
struct TraceCounts {
  std::size_t swaths = 0;
  std::size_t pieces = 0;
};

/// Follows swaths of lines to the surfaces they end on and finds the pieces of curve they make
/// there. A swath is cut wherever its line meets an edge of the scene; between two such lines
/// nothing changes, and one line decides: it must reach the emitter unblocked, and what is seen of
/// the edges that make the swath must differ on the two sides of the curve. The latter is decided
/// by VisiblePartFinder. One a thread.
class SwathTracer {
 public:
  /// All must outlive the tracer.
  SwathTracer(const SoundScene& scene, const OpaqueScene& opaque, const EmitterStage& stage,
              const TraceLimits& limits = {});

  /// Appends the pieces of curve that a swath makes.
  void trace(const Swath& swath, std::vector<DiscontinuityCurve>& curves);

  const TraceCounts& counts() const { return counts_; }
  const EmitterStage& stage() const { return stage_; }

 private:
  struct Crossing {
    double distance;  ///< along the line, from its start
    int triangle;
    bool is_clear;  ///< well inside the triangle and not along it
  };
  struct Open;
  struct KnownPiece {
    int receiver;
    Vec3 from, to;
  };

  void add_silhouette_limits(const Swath& swath, std::vector<double>& parameters) const;
  void cut(const Swath& swath, double t0, double t1);
  void trace_piece(const Swath& swath, double t0, double t1, std::vector<Open>& open);
  void find_crossings(const SightLine& line);
  bool may_be_event(const Swath& swath, const SightLine& line) const;
  void collect_receivers(const SightLine& line);
  void try_receiver(const Swath& swath, const SightLine& line, int receiver, double t0, double t1,
                    std::vector<Open>& open);
  bool may_matter(const Swath& swath, const SightLine& line, int receiver,
                  const ReceivingPoint& at) const;
  bool is_known(const Swath& swath, int receiver, const Vec3& from, const Vec3& to);
  void finish(const Swath& swath, const Open& piece, std::vector<DiscontinuityCurve>& curves) const;

  const SoundScene& scene_;
  const OpaqueTopology& opaque_;
  const SilhouetteTrees& silhouette_trees_;
  const FlatTree& face_tree_;
  const EmitterStage& stage_;
  TraceLimits limits_;
  std::vector<double> receiver_size_;    ///< diagonals of the bounding boxes
  std::vector<std::vector<int>> backs_;  ///< plane → surfaces that are backs
  std::vector<Span3> contacts_;          ///< of all surfaces
  FlatTree contact_tree_;                ///< over them
  std::vector<bool> is_inner_;           ///< edges between two triangles of one receiver
  VisiblePartFinder finder_;
  VisiblePart left_, right_;
  double step_;  ///< see side_step
  std::vector<double> parameters_;
  std::vector<Crossing> crossings_;
  std::vector<int> reached_;
  bool has_fine_detail_ = false;
  CurveSource known_source_;       ///< what made the pieces below
  std::vector<KnownPiece> known_;  ///< of the plane of one face
  TraceCounts counts_;
};

/// How far to the sides of a curve it is tested what is seen there: far above rounding, far below
/// the size of anything. A length.
double side_step(const SoundScene& scene, const OpaqueScene& opaque);

}  // namespace halfshade
