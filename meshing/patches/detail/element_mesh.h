#pragma once

#include "meshing/core/types.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <array>
#include <span>
#include <vector>

/// For source files of this room only: OpenMesh stays out of what others include.
namespace halfshade {

struct ElementTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::None);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
  EdgeAttributes(OpenMesh::Attributes::None);
  FaceAttributes(OpenMesh::Attributes::None);
  VertexTraits { int shared_point = -1; };  // the same for vertices of several surfaces; −1: none
  EdgeTraits {
    int order = -1;       // of the discontinuity along it; −1: none
    bool marked = false;  // to be split
    int twin = -1;        // the next edge in the ring of those of other surfaces that lie on it
  };
  FaceTraits { int node = -1; };  // of the forest
};
using TriangleMesh = OpenMesh::TriMesh_ArrayKernelT<ElementTraits>;
using VertexHandle = TriangleMesh::VertexHandle;
using HalfedgeHandle = TriangleMesh::HalfedgeHandle;
using EdgeHandle = TriangleMesh::EdgeHandle;
using FaceHandle = TriangleMesh::FaceHandle;

/// Elements and all that they are parts of, one entry a node; leaves have a face of the mesh.
struct ElementForest {
  std::vector<int> parent;   ///< −1 at roots
  std::vector<int> level;    ///< number of ancestors
  std::vector<int> surface;  ///< that it lies in
  /// Of nodes that have parts: vertices, and orders of the edges from each to the next; else −1.
  std::vector<std::array<int, 3>> corners, edge_order;

  int count() const { return static_cast<int>(parent.size()); }
  /// Return the new node.
  int add_root(int of_surface);
  int add_child(int of_node);
};

/// The elements of all surfaces. Each surface is a part of its own; where surfaces share an edge,
/// their edges there are twins.
struct ElementMesh {
  TriangleMesh triangles;
  ElementForest forest;
  int shared_points = 0;  ///< how many there are
};

Vec3 position(const TriangleMesh& mesh, int vertex);

/// The two vertices, or shared points, of an edge, the lower one first.
std::array<int, 2> ends(const TriangleMesh& mesh, EdgeHandle edge);
std::array<int, 2> shared_ends(const TriangleMesh& mesh, EdgeHandle edge);

/// Bisects the triangles at an edge. Parts of it have its order, and no twins yet; new faces
/// inherit the node of the one they are a part of. Returns the new vertex.
VertexHandle split_edge(TriangleMesh& mesh, EdgeHandle edge, const OpenMesh::Vec3d& middle);

/// Makes rings of those edges that run between the same shared points.
void link_twins(TriangleMesh& mesh, const std::vector<EdgeHandle>& edges);

/// The faces as elements are numbered: by surface, then in order of creation.
std::vector<FaceHandle> ordered_faces(const ElementMesh& mesh);

/// Faces of elements. Throws Error(contract) if there are no such elements.
std::vector<FaceHandle> named_faces(const ElementMesh& mesh, std::span<const int> elements);

}  // namespace halfshade
