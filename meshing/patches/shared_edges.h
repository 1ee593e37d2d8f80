#pragma once

#include "meshing/geometry/flat_tree.h"
#include "meshing/patches/shared_lines.h"
#include "meshing/triangulation/curve_mesh.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// The rings and contact lines of a surface with further points on them.
struct Outline {
  std::vector<Ring> rings;
  std::vector<Segment2> contacts;
};

/// An edge of a surface's mesh on a ring or contact line.
struct BorderEdge {
  std::array<int, 2> points{};  ///< of the mesh
  Segment2 ends;                ///< in the surface's frame
};
using BorderEdges = std::vector<BorderEdge>;

/// The constrained edges of a mesh on rings and contact lines.
BorderEdges border_edges(const CurveMesh& mesh);

/// Brings the subdivision of borders that lie on each other into agreement: keeps, for every shared
/// line, the points that all surfaces along it are to have.
class SharedEdges {
 public:
  /// Starts with the ends of all borders. `scene` must outlive the object.
  explicit SharedEdges(const SoundScene& scene);

  const SharedLines& lines() const { return lines_; }

  /// The border of a surface that an edge of its mesh lies on, or −1.
  int border_of(int surface, const Segment2& edge) const;

  /// A point of a surface where something ends.
  struct End {
    int surface = 0;
    Vec2 point = Vec2::Zero();
    double snap = 0;  ///< it may be moved this far along its border
  };
  /// Adds those points that lie on shared lines, to within their snap, and not near points that
  /// are there already.
  void add(std::span<const End> ends);

  /// What a surface is to be meshed with.
  Outline outline(int surface) const;

  /// Compares the meshes of all surfaces. Between neighbouring points of a line, the finest
  /// subdivision becomes that of all. Returns the surfaces that do not have it, sorted.
  std::vector<int> compare(std::span<const CurveMesh> meshes);

 private:
  struct Vertex {
    std::size_t interval;  // of the line's points, by its end
    int border;
    double t;
    auto operator<=>(const Vertex&) const = default;
  };
  void agree(std::size_t line, std::vector<Vertex> vertices, std::vector<bool>& differs);
  std::vector<double> inside(int line, double begin, double end) const;

  const SoundScene& scene_;
  SharedLines lines_;
  std::vector<FlatTree> trees_;              // of each surface's borders, in its frame
  std::vector<std::vector<double>> agreed_;  // [line]: sorted, farther apart than the tolerance
};

}  // namespace halfshade
