#include "meshing/patches/patch_mesh.h"

// OpenMesh copies points before it sets them, which GCC notices when it sanitizes. For the whole
// file, as the copying ends up in the standard library's headers.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "meshing/core/error.h"
#include "meshing/geometry/corner_fans.h"
#include "meshing/patches/face_lookup.h"
#include "meshing/patches/shared_places.h"
#include "meshing/patches/surface_meshes.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace halfshade {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::None);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
  EdgeAttributes(OpenMesh::Attributes::None);
  FaceAttributes(OpenMesh::Attributes::None);
  VertexTraits { int place = -1; };  // the same for vertices of surfaces that share an edge
  EdgeTraits {
    int order = -1;       // of the discontinuity along it; −1: none
    bool marked = false;  // to be split
    int twin = -1;        // the next edge in the ring of those of other surfaces that lie on it
  };
  FaceTraits { int node = -1; };  // of the hierarchy
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Link = std::array<int, 2>;

Link sorted(int a, int b) { return a < b ? Link{a, b} : Link{b, a}; }

Vec3 to_vec(const OpenMesh::Vec3d& p) { return {p[0], p[1], p[2]}; }

// What elements() needs of a surface to label its elements with input faces.
struct SurfaceInfo {
  PlaneFrame frame;
  int group = 0, material = 0;
  FaceLookup faces;
};

}  // namespace

struct PatchMesh::Impl {
  Mesh mesh;
  std::vector<SurfaceInfo> surfaces;
  int places = 0;  // how many there are
  // The hierarchy, one entry a node; leaves have a face of the mesh.
  std::vector<int> parent, level, surface;

  void add(const SoundScene& scene, const SharedEdges& shared, std::span<const WalledMesh> meshes,
           std::span<const std::vector<int>> orders);
  void add(const Surface& surface, const PlanarMesh& planar, std::span<const int> orders,
           const SharedPlaces& shared);
  int add_root(int surface);
  void fill_gaps(const std::vector<Mesh::VertexHandle>& vertex, const std::vector<int>& point,
                 const SharedPlaces& shared);
  void link_twins(const std::vector<Mesh::EdgeHandle>& edges);
  Link place_ends(Mesh::EdgeHandle edge) const;
  std::vector<Mesh::FaceHandle> ordered_faces() const;
  std::vector<Mesh::FaceHandle> named_faces(std::span<const int> elements) const;
  Mesh::HalfedgeHandle first_halfedge(Mesh::FaceHandle face) const;
  void describe(int node, const std::array<int, 3>& corners, ElementTable& table) const;
  Vec3 position(int vertex) const { return to_vec(mesh.point(Mesh::VertexHandle(vertex))); }

  Link ends(Mesh::EdgeHandle edge) const;
  bool longer(Mesh::EdgeHandle a, Mesh::EdgeHandle b) const;
  Mesh::EdgeHandle longest_edge(Mesh::FaceHandle face) const;
  void mark(Mesh::EdgeHandle edge, std::vector<Mesh::EdgeHandle>& marked);
  std::vector<Mesh::EdgeHandle> close_marks(std::vector<Mesh::EdgeHandle> marked);
  std::map<int, bool> marked_triangles(const std::vector<Mesh::EdgeHandle>& marked) const;
  Mesh::VertexHandle split_edge(Mesh::EdgeHandle edge, const OpenMesh::Vec3d& position);
  void split_marked(std::vector<Mesh::EdgeHandle> marked);
  void name_children(const std::vector<Mesh::FaceHandle>& faces);
};

// Puts the meshes of all surfaces in, with the orders of their constrained edges.
void PatchMesh::Impl::add(const SoundScene& scene, const SharedEdges& shared,
                          std::span<const WalledMesh> meshes,
                          std::span<const std::vector<int>> orders) {
  const SharedPlaces common = shared_places(scene, shared, meshes);
  places = static_cast<int>(common.position.size());
  for (std::size_t r = 0; r < meshes.size(); ++r)
    add(scene.surfaces[r], *meshes[r].mesh, orders[r], common);
  std::vector<Mesh::EdgeHandle> walls;
  for (const auto edge : mesh.edges())
    if (mesh.data(edge).order == 0) walls.push_back(edge);
  link_twins(walls);
}

int PatchMesh::Impl::add_root(int id) {
  parent.push_back(-1);
  level.push_back(0);
  surface.push_back(id);
  return static_cast<int>(parent.size()) - 1;
}

// Where triangles touch in a point without sharing an edge, the point becomes several vertices,
// for OpenMesh takes manifold meshes only.
void PatchMesh::Impl::add(const Surface& source, const PlanarMesh& planar,
                          std::span<const int> orders, const SharedPlaces& shared) {
  const int id = static_cast<int>(surfaces.size());
  surfaces.push_back({source.frame, source.group, source.material, FaceLookup(source)});
  const CornerFans fans = corner_fans(planar.triangles, edge_neighbours(planar.triangles));
  std::vector<Mesh::VertexHandle> vertex(at(fans.count));
  std::vector<int> point(at(fans.count));
  for (std::size_t t = 0; t < planar.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) point[at(fans.of_corner[t][k])] = planar.triangles[t][k];
  for (std::size_t v = 0; v < vertex.size(); ++v) {
    const int place = shared.place[at(id)][at(point[v])];
    const Vec3 p =
        place < 0 ? source.frame.to_space(planar.points[at(point[v])]) : shared.position[at(place)];
    vertex[v] = mesh.add_vertex({p.x(), p.y(), p.z()});
    mesh.data(vertex[v]).place = place;
  }
  const auto point_of = [&](Mesh::VertexHandle v) { return point[at(v.idx() - vertex[0].idx())]; };
  const auto& constrained = planar.constrained_edges;
  for (const auto& corners : fans.of_corner) {
    const auto face =
        mesh.add_face(vertex[at(corners[0])], vertex[at(corners[1])], vertex[at(corners[2])]);
    if (!face.is_valid())
      throw Error(ErrorCode::contract, "PatchMesh",
                  fmt::format("the triangulation of surface {} is not a surface", id));
    mesh.data(face).node = add_root(id);
    for (const auto edge : mesh.fe_range(face)) {
      const Link link = ends(edge);
      const Link key =
          sorted(point_of(Mesh::VertexHandle(link[0])), point_of(Mesh::VertexHandle(link[1])));
      const auto found = std::lower_bound(constrained.begin(), constrained.end(), key);
      if (found != constrained.end() && *found == key)
        mesh.data(edge).order = orders[static_cast<std::size_t>(found - constrained.begin())];
    }
  }
  fill_gaps(vertex, point, shared);
}

// Splits edges where only neighbours have points. The parts are elements of their own.
void PatchMesh::Impl::fill_gaps(const std::vector<Mesh::VertexHandle>& vertex,
                                const std::vector<int>& point, const SharedPlaces& shared) {
  const auto& gaps = shared.gaps[surfaces.size() - 1];
  if (gaps.empty()) return;
  std::map<Link, Mesh::EdgeHandle> edges;
  for (std::size_t v = 0; v < vertex.size(); ++v)
    for (const auto half : mesh.voh_range(vertex[v])) {
      const int other = point[at(mesh.to_vertex_handle(half).idx() - vertex[0].idx())];
      edges.emplace(Link{point[v], other}, mesh.edge_handle(half));
    }
  for (const auto& gap : gaps) {
    auto edge = edges.at(gap.edge);
    Link link = ends(edge);
    if (point[at(link[1] - vertex[0].idx())] != gap.edge[1]) std::swap(link[0], link[1]);
    const Mesh::VertexHandle last(link[1]);
    for (const int place : gap.places) {
      const Vec3& p = shared.position[at(place)];
      const auto middle = split_edge(edge, {p.x(), p.y(), p.z()});
      mesh.data(middle).place = place;
      std::map<int, Mesh::FaceHandle> halves;  // of one triangle, by its node
      for (const auto face : mesh.vf_range(middle))
        if (!halves.emplace(mesh.data(face).node, face).second)
          mesh.data(face).node = add_root(static_cast<int>(surfaces.size()) - 1);
      edge = mesh.edge_handle(mesh.find_halfedge(middle, last));
    }
  }
}

Link PatchMesh::Impl::place_ends(Mesh::EdgeHandle edge) const {
  const Link link = ends(edge);
  return sorted(mesh.data(Mesh::VertexHandle(link[0])).place,
                mesh.data(Mesh::VertexHandle(link[1])).place);
}

// Makes rings of those edges that run between the same places.
void PatchMesh::Impl::link_twins(const std::vector<Mesh::EdgeHandle>& edges) {
  std::vector<std::pair<Link, int>> keys;
  for (const auto edge : edges)
    if (const Link key = place_ends(edge); key[0] >= 0) keys.emplace_back(key, edge.idx());
  std::sort(keys.begin(), keys.end());
  for (std::size_t first = 0, last = 0; first < keys.size(); first = last) {
    while (last < keys.size() && keys[last].first == keys[first].first) ++last;
    for (std::size_t i = first; i < last && last - first > 1; ++i)
      mesh.data(Mesh::EdgeHandle(keys[i].second)).twin = keys[i + 1 < last ? i + 1 : first].second;
  }
}

std::vector<Mesh::FaceHandle> PatchMesh::Impl::ordered_faces() const {
  std::vector<Mesh::FaceHandle> faces(mesh.faces_begin(), mesh.faces_end());
  std::sort(faces.begin(), faces.end(), [&](auto a, auto b) {
    const int m = mesh.data(a).node, n = mesh.data(b).node;
    return std::pair(surface[at(m)], m) < std::pair(surface[at(n)], n);
  });
  return faces;
}

Link PatchMesh::Impl::ends(Mesh::EdgeHandle edge) const {
  const auto half = mesh.halfedge_handle(edge, 0);
  return sorted(mesh.from_vertex_handle(half).idx(), mesh.to_vertex_handle(half).idx());
}

// A strict order of all edges, so that both triangles at an edge agree and the closure ends.
bool PatchMesh::Impl::longer(Mesh::EdgeHandle a, Mesh::EdgeHandle b) const {
  const Link m = ends(a), n = ends(b);
  const auto length = [&](const Link& link) {
    return (position(link[1]) - position(link[0])).squaredNorm();
  };
  const double length_m = length(m), length_n = length(n);
  return length_m > length_n || (length_m == length_n && m < n);
}

Mesh::EdgeHandle PatchMesh::Impl::longest_edge(Mesh::FaceHandle face) const {
  Mesh::EdgeHandle best;
  for (const auto edge : mesh.fe_range(face))
    if (!best.is_valid() || longer(edge, best)) best = edge;
  return best;
}

// Marks the longest edge of every triangle that has a marked edge. Returns all marked edges.
std::vector<Mesh::EdgeHandle> PatchMesh::Impl::close_marks(std::vector<Mesh::EdgeHandle> marked) {
  for (std::size_t i = 0; i < marked.size(); ++i)
    for (int side = 0; side < 2; ++side) {
      const auto face =
          mesh.face_handle(mesh.halfedge_handle(marked[i], static_cast<unsigned>(side)));
      if (!face.is_valid()) continue;
      mark(longest_edge(face), marked);
    }
  return marked;
}

// Bisects the triangles at an edge. New faces inherit the node of the one they are a part of.
Mesh::VertexHandle PatchMesh::Impl::split_edge(Mesh::EdgeHandle edge,
                                               const OpenMesh::Vec3d& position) {
  struct Side {
    Mesh::VertexHandle apex;
    int node;
  };
  std::vector<Side> sides;
  for (unsigned k = 0; k < 2; ++k) {
    const auto half = mesh.halfedge_handle(edge, k);
    if (const auto face = mesh.face_handle(half); face.is_valid())
      sides.push_back(
          {mesh.to_vertex_handle(mesh.next_halfedge_handle(half)), mesh.data(face).node});
  }
  const Link old_ends = ends(edge);
  const int order = mesh.data(edge).order;
  const auto middle = mesh.add_vertex(position);
  mesh.split(edge, middle);
  for (const auto half : mesh.voh_range(middle)) {
    const int other = mesh.to_vertex_handle(half).idx();
    auto& data = mesh.data(mesh.edge_handle(half));
    data.marked = false;
    data.twin = -1;
    data.order = other == old_ends[0] || other == old_ends[1] ? order : -1;
    for (const Side& side : sides) {
      if (side.apex.idx() != other) continue;
      const auto left = mesh.face_handle(half);
      const auto right = mesh.face_handle(mesh.opposite_halfedge_handle(half));
      mesh.data(left).node = side.node;
      mesh.data(right).node = side.node;
    }
  }
  return middle;
}

// For every triangle with marked edges (by node) whether all three are.
std::map<int, bool> PatchMesh::Impl::marked_triangles(
    const std::vector<Mesh::EdgeHandle>& marked) const {
  std::map<int, bool> result;
  for (const auto edge : marked)
    for (unsigned side = 0; side < 2; ++side) {
      const auto face = mesh.face_handle(mesh.halfedge_handle(edge, side));
      if (!face.is_valid()) continue;
      bool all = true;
      for (const auto e : mesh.fe_range(face)) all = all && mesh.data(e).marked;
      result[mesh.data(face).node] = all;
    }
  return result;
}

// Splits marked edges, longest first, so that each triangle is bisected at its longest edge before
// its parts are (green, blue); where all three edges were split, the inner edge is then turned to
// join the other two midpoints (red).
void PatchMesh::Impl::split_marked(std::vector<Mesh::EdgeHandle> marked) {
  marked = close_marks(std::move(marked));
  const std::map<int, bool> touched = marked_triangles(marked);
  std::sort(marked.begin(), marked.end(), [&](auto a, auto b) { return longer(a, b); });
  std::map<int, Link> inner;             // red node → middle of its longest edge, opposite corner
  std::map<Link, int> middles;           // ends of twins → place of their middle
  std::vector<Mesh::EdgeHandle> halves;  // of twins
  for (const auto edge : marked) {
    for (unsigned side = 0; side < 2; ++side) {
      const auto half = mesh.halfedge_handle(edge, side);
      const auto face = mesh.face_handle(half);
      if (!face.is_valid() || !touched.at(mesh.data(face).node)) continue;
      const int apex = mesh.to_vertex_handle(mesh.next_halfedge_handle(half)).idx();
      const int middle = static_cast<int>(mesh.n_vertices());
      inner.emplace(mesh.data(face).node, Link{middle, apex});  // the first is the longest
    }
    const bool is_twin = mesh.data(edge).twin >= 0;
    const Link link = ends(edge), key = place_ends(edge);
    const auto middle = split_edge(edge, 0.5 * (mesh.point(Mesh::VertexHandle(link[0])) +
                                                mesh.point(Mesh::VertexHandle(link[1]))));
    if (!is_twin) continue;
    const auto [place, is_new] = middles.emplace(key, places);
    if (is_new) ++places;
    mesh.data(middle).place = place->second;
    for (const int end : link)
      halves.push_back(mesh.edge_handle(mesh.find_halfedge(middle, Mesh::VertexHandle(end))));
  }
  link_twins(halves);
  for (const auto& [node, link] : inner) {
    const auto half = mesh.find_halfedge(Mesh::VertexHandle(link[0]), Mesh::VertexHandle(link[1]));
    mesh.flip(mesh.edge_handle(half));
  }
  std::vector<Mesh::FaceHandle> changed;
  for (const auto face : mesh.faces())
    if (touched.contains(mesh.data(face).node)) changed.push_back(face);
  name_children(changed);
}

// Gives the parts of split elements nodes of their own, in the order of their parents.
void PatchMesh::Impl::name_children(const std::vector<Mesh::FaceHandle>& faces) {
  std::vector<std::pair<int, int>> order;
  for (const auto face : faces) order.emplace_back(mesh.data(face).node, face.idx());
  std::sort(order.begin(), order.end());
  for (const auto& [node, face] : order) {
    mesh.data(Mesh::FaceHandle(face)).node = static_cast<int>(parent.size());
    parent.push_back(node);
    level.push_back(level[at(node)] + 1);
    surface.push_back(surface[at(node)]);
  }
}

// The halfedge that leaves the corner that was made first.
Mesh::HalfedgeHandle PatchMesh::Impl::first_halfedge(Mesh::FaceHandle face) const {
  const auto start = mesh.halfedge_handle(face);
  auto best = start;
  for (auto half = mesh.next_halfedge_handle(start); half != start;
       half = mesh.next_halfedge_handle(half))
    if (mesh.from_vertex_handle(half).idx() < mesh.from_vertex_handle(best).idx()) best = half;
  return best;
}

void PatchMesh::Impl::describe(int node, const std::array<int, 3>& corners,
                               ElementTable& table) const {
  const Vec3 a = position(corners[0]), b = position(corners[1]), c = position(corners[2]);
  const SurfaceInfo& info = surfaces[at(surface[at(node)])];
  table.area.push_back(0.5 * (b - a).cross(c - a).norm());
  table.normal.push_back(info.frame.normal);
  table.surface.push_back(surface[at(node)]);
  table.face.push_back(info.faces.face_at(info.frame.to_plane((a + b + c) / 3)));
  table.group.push_back(info.group);
  table.material.push_back(info.material);
  table.level.push_back(level[at(node)]);
}

std::vector<Mesh::FaceHandle> PatchMesh::Impl::named_faces(std::span<const int> elements) const {
  const std::vector<Mesh::FaceHandle> faces = ordered_faces();
  std::vector<Mesh::FaceHandle> named;
  for (const int e : elements) {
    if (e < 0 || e >= static_cast<int>(faces.size()))
      throw Error(ErrorCode::contract, "PatchMesh",
                  fmt::format("element {} is to be split, but there are {}", e, faces.size()));
    named.push_back(faces[at(e)]);
  }
  return named;
}

// With all its twins.
void PatchMesh::Impl::mark(Mesh::EdgeHandle edge, std::vector<Mesh::EdgeHandle>& marked) {
  while (!mesh.data(edge).marked) {
    mesh.data(edge).marked = true;
    marked.push_back(edge);
    if (mesh.data(edge).twin >= 0) edge = Mesh::EdgeHandle(mesh.data(edge).twin);
  }
}

PatchMesh::PatchMesh(const SoundScene& scene, const PlanarMeshOptions& options,
                     const Progress& progress)
    : impl_(std::make_unique<Impl>()) {
  check_size(scene, options);
  SharedEdges shared(scene);
  const SurfaceMeshes made =
      mesh_surfaces(without_curves(scene, options), shared, options.max_triangles, progress);
  std::vector<WalledMesh> walled;
  std::vector<std::vector<int>> orders;
  for (const CurveMesh& mesh : made.meshes) {
    walled.push_back({&mesh.mesh, wall_edges(mesh)});
    orders.push_back(edge_orders(mesh, {}));
  }
  impl_->add(scene, shared, walled, orders);
}

PatchMesh::PatchMesh(const SoundScene& scene, std::span<const CurveMesh> meshes,
                     std::span<const int> curve_order)
    : impl_(std::make_unique<Impl>()) {
  if (meshes.size() != scene.surfaces.size())
    throw Error(
        ErrorCode::contract, "PatchMesh",
        fmt::format("{} meshes are given for {} surfaces", meshes.size(), scene.surfaces.size()));
  std::vector<WalledMesh> walled;
  std::vector<std::vector<int>> orders;
  for (const CurveMesh& mesh : meshes) {
    walled.push_back({&mesh.mesh, wall_edges(mesh)});
    orders.push_back(edge_orders(mesh, curve_order));
  }
  impl_->add(scene, SharedEdges(scene), walled, orders);
}

PatchMesh::~PatchMesh() = default;
PatchMesh::PatchMesh(PatchMesh&&) noexcept = default;
PatchMesh& PatchMesh::operator=(PatchMesh&&) noexcept = default;

int PatchMesh::element_count() const { return static_cast<int>(impl_->mesh.n_faces()); }

ElementTable PatchMesh::elements() const {
  const Mesh& mesh = impl_->mesh;
  const std::vector<Mesh::FaceHandle> faces = impl_->ordered_faces();
  std::vector<int> element(faces.size());
  for (std::size_t e = 0; e < faces.size(); ++e) element[at(faces[e].idx())] = static_cast<int>(e);
  ElementTable table;
  std::vector<std::array<int, 3>> vertices;
  for (const auto face : faces) {
    std::array<int, 3> corners{}, across{}, order{};
    auto half = impl_->first_halfedge(face);
    for (std::size_t k = 0; k < 3; ++k, half = mesh.next_halfedge_handle(half)) {
      corners[k] = mesh.from_vertex_handle(half).idx();
      const auto other = mesh.face_handle(mesh.opposite_halfedge_handle(half));
      order[k] = mesh.data(mesh.edge_handle(half)).order;
      across[k] = other.is_valid() && order[k] != 0 ? element[at(other.idx())] : -1;
    }
    vertices.push_back(corners);
    table.neighbours.push_back(across);
    table.edge_order.push_back(order);
    impl_->describe(mesh.data(face).node, corners, table);
  }
  const CornerFans fans = corner_fans(vertices, table.neighbours);
  table.points.resize(at(fans.count));
  table.corners = fans.of_corner;
  for (std::size_t e = 0; e < vertices.size(); ++e)
    for (std::size_t k = 0; k < 3; ++k)
      table.points[at(fans.of_corner[e][k])] = impl_->position(vertices[e][k]);
  return table;
}

PatchHierarchy PatchMesh::hierarchy() const {
  PatchHierarchy result{impl_->parent, impl_->level, std::vector<int>(impl_->parent.size(), -1)};
  int element = 0;
  for (const auto face : impl_->ordered_faces())
    result.element[at(impl_->mesh.data(face).node)] = element++;
  return result;
}

void PatchMesh::split_in_four(std::span<const int> elements) {
  std::vector<Mesh::EdgeHandle> marked;
  for (const auto face : impl_->named_faces(elements))
    for (const auto edge : impl_->mesh.fe_range(face)) impl_->mark(edge, marked);
  impl_->split_marked(std::move(marked));
}

void PatchMesh::bisect(std::span<const int> elements) {
  std::vector<Mesh::EdgeHandle> marked;
  for (const auto face : impl_->named_faces(elements))
    impl_->mark(impl_->longest_edge(face), marked);
  impl_->split_marked(std::move(marked));
}

double length_for_count(const SoundScene& scene, int element_count) {
  if (element_count < 1)
    throw Error(ErrorCode::contract, "length_for_count",
                fmt::format("{} elements are asked for; it takes at least 1", element_count));
  // Measured over rooms: triangles of a mesh with longest edge h have 0.2 h² on average.
  constexpr double mean_area = 0.2;
  double total = 0;
  for (const Surface& surface : scene.surfaces) total += area(surface);
  return std::sqrt(total / (mean_area * element_count));
}

}  // namespace halfshade
