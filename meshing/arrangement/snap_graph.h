#pragma once

#include "meshing/arrangement/point_grid.h"
#include "meshing/core/types.h"
#include "meshing/geometry/flat_tree.h"

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace halfshade {

/// A planar straight-line graph of a fixed part that stays where it is and lines that are snapped
/// to it and to each other. Once settled,
/// 1. no two edges cross;
/// 2. points that are not fixed are at least snap/2 from all others (snap, where neither lies on
///    a fixed edge) and from fixed edges they do not lie on;
/// 3. edges that are not fixed run through every point within snap/3 of them, save where they
///    would have to grow or to cross a fixed edge to reach it;
/// 4. every line is a chain of edges within a few snap of it.
/// Settling ends: an edge is only ever replaced by strictly shorter ones, and there is room for
/// finitely many points. See curve_mesh.md.
///
/// arrange() does not serve here: it knows no edges that must stay, splits fixed edges at points
/// beside them, and lets points come as close to each other and to edges as they like down to its
/// radii, so that curves that run along a surface's border would leave slivers. Both find their
/// pairs with SegmentPairs and their points with PointGrid.
class SnapGraph {
 public:
  struct Edge {
    int a = 0, b = 0;  // a < b
    bool is_fixed = false;
    bool is_unrouted = true, is_uncrossed = true;  // not yet held against all others
    int first_part = 0, part_count = 0;            // of parts_, from a to b; 0: present
  };

  /// `snap` must exceed the rounding of the coordinates by far.
  explicit SnapGraph(double snap);

  int add_fixed_point(const Vec2& p);
  /// Fixed edges must meet at common points only. Returns the edge.
  int add_fixed_edge(int a, int b);
  /// Adds a line. Its ends take the place of a point or fixed edge nearby; of points that came with
  /// lines only such within `merge` ≤ snap. Returns its edge, −1 if both ends are one point.
  int add_line(const Vec2& from, const Vec2& to, double merge);
  int add_line(const Vec2& from, const Vec2& to) { return add_line(from, to, snap_); }

  /// False if it did not end in reasonable time: try again with a larger `snap`.
  bool settle();
  /// Makes all present edges and their points fixed.
  void freeze();

  const std::vector<Vec2>& points() const { return points_; }
  const std::vector<Edge>& edges() const { return edges_; }

  /// The present edge between two points, or −1.
  int edge_between(int a, int b) const;

  /// Calls visit(edge) for the present edges that an edge has become.
  template <class Visit>
  void for_each_part(int edge, const Visit& visit) const {
    const Edge& e = edges_[static_cast<std::size_t>(edge)];
    if (e.part_count == 0) visit(edge);
    for (int k = 0; k < e.part_count; ++k)
      for_each_part(parts_[static_cast<std::size_t>(e.first_part + k)], visit);
  }

 private:
  struct Insert {
    int edge;
    double along;
    int point;
    bool is_for_fixed;
    auto operator<=>(const Insert&) const = default;
  };
  using Pair = std::array<int, 2>;

  const Vec2& place(int point) const { return points_[static_cast<std::size_t>(point)]; }
  Edge& edge(int e) { return edges_[static_cast<std::size_t>(e)]; }
  const Edge& edge(int e) const { return edges_[static_cast<std::size_t>(e)]; }
  double distance(int a, int b) const { return (place(a) - place(b)).norm(); }

  int new_point(const Vec2& p);
  bool is_hidden(const Vec2& p, const Vec2& q);
  int point_for(const Vec2& p, double merge, const std::array<int, 4>& ends);
  template <class Accept>
  int point_on(int fixed_edge, const Vec2& p, const Accept& accept);
  int nearest_fixed_edge(const Vec2& p, double radius);
  int add_edge(int a, int b, bool is_fixed);
  void insert(int edge, int point);

  std::vector<int> present() const;
  void index_fixed_edges();
  bool lead_through_points();
  bool split_at_crossings();
  void resolve(const Pair& crossing);
  bool apply_inserts();

  double snap_;
  std::vector<Vec2> points_;
  std::vector<bool> is_fixed_point_, is_fresh_point_;
  PointGrid grid_;
  std::vector<Edge> edges_;
  std::unordered_map<std::uint64_t, int> edge_of_;  // by its points
  std::vector<int> parts_;
  std::vector<Insert> inserts_;
  std::unordered_map<std::uint64_t, bool> awaits_insert_;  // by edge and point
  std::vector<int> indexed_;                               // fixed edges in the tree
  std::optional<FlatTree> fixed_tree_;
};

}  // namespace halfshade
