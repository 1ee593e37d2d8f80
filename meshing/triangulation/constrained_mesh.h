#pragma once

#include "meshing/core/types.h"

#include <array>
#include <optional>
#include <vector>

namespace halfshade {

/// A constrained Delaunay triangulation that points can be added to. Side k of a triangle runs from
/// corner k to corner k + 1.
struct ConstrainedMesh {
  struct Triangle {
    std::array<int, 3> corner{};      ///< counter-clockwise
    std::array<int, 3> neighbour{};   ///< beyond each side; −1 at the border
    std::array<int, 3> constraint{};  ///< id of the one that each side lies on; −1: none
  };
  std::vector<Vec2> points;
  std::vector<Triangle> triangles;

  const Vec2& point(int p) const { return points[at(p)]; }
  const Triangle& triangle(int t) const { return triangles[at(t)]; }
};

/// A side of a triangle.
struct Side {
  int triangle = -1;
  std::size_t k = 0;
};

/// Where the straight way from the middle of a triangle to a point ends: in the triangle that holds
/// the point, or at the side of a constraint or the border.
struct Arrival {
  Side side;
  bool is_blocked = false;
};

/// Nothing if rounding leads astray.
std::optional<Arrival> walk(const ConstrainedMesh& mesh, int triangle, const Vec2& target);

/// The place that a new point takes: all triangles whose circle it lies in and that it sees.
class Cavity {
 public:
  struct Rim {
    Side side;  ///< of a triangle of the cavity
    int from, to;
    int beyond, constraint;
  };

  explicit Cavity(ConstrainedMesh& mesh) : mesh_(mesh) {}

  /// For a point inside a triangle.
  void find(const Vec2& p, int triangle);
  /// For a point on a side, which is to be split there. The point may be off it by rounding.
  void find(const Vec2& p, const Side& split);

  const std::vector<Rim>& rim() const { return rim_; }

  /// Adds the point; `changed` gets the new triangles. False, and nothing done, if a triangle would
  /// turn over.
  bool fill(std::vector<int>& changed);

 private:
  void grow();
  int starting_at(int vertex) const { return starting_at_[at(vertex)]; }

  ConstrainedMesh& mesh_;
  Vec2 p_ = Vec2::Zero();
  std::array<int, 2> split_ends_ = {-1, -1};
  int split_constraint_ = -1;
  std::vector<int> inside_;
  std::vector<Rim> rim_;
  std::vector<unsigned> mark_;  // [triangle] number of the cavity it was last part of
  unsigned number_ = 0;
  std::vector<int> starting_at_;  // [vertex] new triangle whose rim side starts there
};

}  // namespace halfshade
