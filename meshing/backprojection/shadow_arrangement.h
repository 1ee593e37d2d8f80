#pragma once

#include "meshing/backprojection/edge_id.h"
#include "meshing/backprojection/emitter_outline.h"
#include "meshing/backprojection/point_view.h"

#include <array>
#include <vector>

namespace halfshade {

/// A piece of the visible part's boundary. `start` and `end` are junctions, where pieces meet:
/// crossings, then corners; the same number is the same direction.
struct ArrangedPiece {
  Vec3 from, to;
  EdgeId edge;
  int start, end;
};

/// The arrangement of the emitter's outline and the occluders' silhouettes, as far as it bounds the
/// visible part. Keeps its buffers.
class ShadowArrangement {
 public:
  std::vector<ArrangedPiece> pieces;
  bool fully_lit = false;  ///< the pieces are exactly the outline's edges
  /// False if rounding put three edges that nearly meet in a point in contradictory orders.
  bool is_consistent = true;
  int junction_count = 0;  ///< junctions are numbered from 0

  std::size_t crossing_count() const { return crossings_.size(); }
  bool is_crossing(int junction) const { return junction < static_cast<int>(crossings_.size()); }

  /// False, with nothing built, if many faces lie behind each other, or if there are many crossings
  /// for the view's arcs and hardly any of them is seen.
  bool build(PointView& view, const EmitterOutline& outline, bool unless_crowded = false);

 private:
  /// An arc with `weight` more faces on its left than on its right; for the outline, the emitter is
  /// on the left.
  struct Arc {
    int from, to, weight;
    EdgeId edge;
    bool is_outline = false, is_done = false;
    int start_layers = 0;  // on its right, where it starts inside
    Vec2 low = Vec2::Zero(), high = Vec2::Zero();
    int first = 0, count = 0;  // crossings, a range of order_
  };
  /// Two arcs that cross, where on each, and how much more lies behind than before the crossing for
  /// who runs along it.
  struct Crossing {
    std::array<int, 2> arc;
    std::array<double, 2> along;
    std::array<int, 2> step;
    int layers = 0;  // right of the silhouette, just inside the outline
  };

  bool is_hidden_by(int surface);
  bool passes_outline(int from, int to) const;
  bool is_outline_behind(const OpaqueTopology::OpaqueSurface& surface) const;
  bool find_near_faces();
  void collect_silhouettes();
  void collect_near();
  void collect_among(const std::vector<int>& triangles);
  void collect_cuts_of(int triangle);
  void collect_cuts();
  void put_in_order();
  void join_repeated();
  void consider_edge(int edge);
  void consider_inside(int edge);
  void add_arc(int from, int to, int weight, EdgeId edge);
  bool set_box(Arc& arc) const;

  bool find_crossings(bool unless_crowded);
  bool is_much_seen() const;
  bool cross(int a, int b);
  void locate_crossing(Crossing& crossing) const;
  void sort_crossings();
  bool is_before(int arc, int a, int b) const;

  void walk_outline();
  void walk_silhouettes();
  void walk_chain(int arc, bool inside, int layers);
  bool walk_arc(int arc, bool inside, int& layers);
  bool enters_first(const Arc& arc) const;
  bool is_inside(const DirectionBeside& direction) const;
  void emit(const Arc& arc, std::array<double, 2> along, std::array<int, 2> junctions, int layers);

  int junction_of(int corner) const { return static_cast<int>(crossings_.size()) + corner; }
  Vec3 position(const Arc& arc, double along) const;
  int side_of(const Crossing& crossing, int arc) const { return crossing.arc[0] == arc ? 0 : 1; }

  int first_layers_ = 0;  // just inside the outline, after the start of its first edge
  PointView* view_ = nullptr;
  const EmitterOutline* outline_ = nullptr;
  std::vector<Arc> arcs_;  // the outline's first
  std::vector<Crossing> crossings_;
  std::vector<int> order_, sweep_, active_, near_faces_, near_edges_;
  struct Meeting {
    int in = 0, out = 0, next = -1;  // silhouettes that end and start here; one that starts
  };
  std::vector<Meeting> meetings_;  // one a corner
};

}  // namespace halfshade
