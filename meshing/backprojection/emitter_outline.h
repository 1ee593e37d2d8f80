#pragma once

#include "meshing/backprojection/border_lines.h"
#include "meshing/backprojection/edge_id.h"
#include "meshing/backprojection/point_view.h"

#include <array>
#include <vector>

namespace halfshade {

/// A straight piece of the boundary of the emitter's part above the horizon; seen from the point
/// the emitter is on its left.
struct OutlineEdge {
  int from, to;  ///< corners
  EdgeId edge;
};

/// Cuts an emitter's rings at the point's horizon. Keeps its buffers.
class EmitterOutline {
 public:
  std::vector<OutlineEdge> edges;  ///< closed chain after closed chain
  SightPyramid pyramid;

  /// False if nothing of the emitter lies above the horizon.
  bool make(PointView& view, const Vec3& point, const Vec3& normal, int emitter);
  /// The same for a triangle of the emitter, counter-clockwise seen from its front, whose edges
  /// count as the emitter's.
  bool make(PointView& view, const Vec3& point, const Vec3& normal,
            const std::array<int, 3>& corners);
  /// Takes back what the view's corners know of it.
  void forget(PointView& view) const;

  const std::vector<BorderLine>& lines_of(const OpaqueTopology& topology, int surface);

  /// For each chain, where the next one starts.
  void copy_ends(std::vector<int>& ends) const;

 private:
  struct Crossing {
    double along;
    int corner;
  };
  void add_edge(PointView& view, int from, int to, EdgeId edge);
  int cross_horizon(PointView& view, int from, int to);
  void start(const PointView& view, const Vec3& point, const Vec3& normal);
  void cut_ring(PointView& view, std::span<const OpaqueTopology::OutlineVertex> ring);
  void cut_edge(PointView& view, int a, int b, EdgeId edge);
  bool close(PointView& view);
  void close_along_horizon(PointView& view);
  void put_in_order(const PointView& view);
  void start_pyramid(const PointView& view);
  void add_side(const PointView& view, const Vec3& out, double inset);
  void add_side_along(const PointView& view, const OutlineEdge& edge);
  double height(const PointView& view, int corner) const;

  Vec3 point_ = Vec3::Zero(), normal_ = Vec3::Zero(), horizon_ = Vec3::Zero();
  std::vector<Crossing> exits_, entries_;
  std::vector<OutlineEdge> unordered_;
  std::vector<int> first_at_, sibling_;
  std::vector<std::vector<BorderLine>> lines_;  // of surfaces; if known
  bool reaches_above_ = false;
};

}  // namespace halfshade
