#pragma once

#include "meshing/backprojection/part_search.h"

#include <array>
#include <functional>
#include <utility>
#include <vector>

namespace halfshade {

/// The visible part of an emitter piece by piece, where too much lies before it to arrange it all:
/// triangles of it that a face hides are done, the others are cut in two. Keeps its buffers.
class VisibleCells {
 public:
  explicit VisibleCells(PartSearch& search) : search_(search) {}

  /// See VisiblePartFinder::find_in_cells.
  std::size_t run(const Vec3& point, const Vec3& normal, int surface, VisiblePart& part,
                  const std::function<void(const VisiblePart&)>& use);

  /// The vertices of triangles that make up an emitter. Also of backs, which have no triangles of
  /// their own in the topology.
  const std::vector<std::array<int, 3>>& triangles_of(int surface);

 private:
  /// A triangle of the emitter, counter-clockwise seen from the front.
  struct Cell {
    std::array<Vec3, 3> corner;
    std::array<int, 3> vertex;  ///< of the topology; −1 in the middle of an edge
  };
  struct Query {
    Vec3 point, normal;
    int surface;
    VisiblePart& part;
    const std::function<void(const VisiblePart&)>& use;
  };

  enum class Cover { none, some, all };

  void collect_faces();
  double size_of(int triangle) const;
  bool make_outline(const Query& query, const Cell& cell);
  bool narrow(std::size_t depth);
  Cover cover_by(int triangle);
  bool is_stuck(std::size_t depth) const;
  void look_at(const Query& query, const Cell& cell, std::size_t depth);
  void arrange(const Query& query, const Cell& cell, std::size_t depth);
  void split(const Query& query, const Cell& cell, std::size_t depth);

  PartSearch& search_;
  std::size_t work_ = 0;
  /// By depth: triangles that may lie before a cell; those that look larger first.
  std::vector<std::vector<int>> faces_;
  std::vector<std::pair<double, int>> sizes_;  ///< how large they look, negated, and triangles
  std::vector<std::vector<std::array<int, 3>>> triangles_;  ///< of surfaces, vertices; if known
};

}  // namespace halfshade
