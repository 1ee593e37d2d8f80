#include "meshing/backprojection/visible_cells.h"

#include "meshing/backprojection/margins.h"
#include "meshing/triangulation/ring_triangles.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// With so few faces before it, a cell is arranged at once.
constexpr std::size_t few_faces = 16;
/// Where faces meet in a direction, smaller cells do not have fewer of them: a cell is arranged
/// that has more than this share of those that one so many cuts before had.
constexpr double stuck = 0.75;
constexpr std::size_t cuts_to_tell = 6;
constexpr std::size_t deepest = 30;

}  // namespace

/// All triangles that may lie between point and emitter. Those that look large are likely to hide
/// something, and are asked first.
void VisibleCells::collect_faces() {
  PointView& view = search_.view;
  const SightPyramid& pyramid = search_.outline.pyramid;
  sizes_.clear();
  walk_tree(
      view.face_tree(),
      [&](int node) { return pyramid.is_outside(view.face_tree().nodes[at(node)].box); },
      [&](int triangle) {
        if (view.face_sign(triangle) != 0) sizes_.emplace_back(-size_of(triangle), triangle);
      });
  std::sort(sizes_.begin(), sizes_.end());
  faces_[0].clear();
  for (const auto& [size, triangle] : sizes_) faces_[0].push_back(triangle);
}

/// How large a triangle looks, roughly, whatever the unit of the scene.
double VisibleCells::size_of(int triangle) const {
  const OpaqueTopology& topology = search_.view.topology();
  const auto& corner = topology.triangles[at(triangle)].corner;
  std::array<Vec3, 3> way;
  for (std::size_t k = 0; k < 3; ++k)
    way[k] = topology.vertices[at(corner[k])] - search_.view.point();
  const double distance = ((way[0] + way[1] + way[2]) / 3).stableNorm();
  for (Vec3& w : way) w /= distance;
  return std::abs(way[0].dot(way[1].cross(way[2])));
}

bool VisibleCells::make_outline(const Query& query, const Cell& cell) {
  PointView& view = search_.view;
  std::array<int, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = cell.vertex[k] >= 0 ? view.corner_of_vertex(cell.vertex[k])
                                     : view.add_corner(cell.corner[k]);
  return search_.outline.make(view, query.point, query.normal, corners);
}

/// How a triangle, as far as it reaches before the emitter's plane, lies to the outline. Seen from
/// the point both are convex.
VisibleCells::Cover VisibleCells::cover_by(int triangle) {
  PointView& view = search_.view;
  std::array<int, 4> p{};
  const std::size_t count = at(view.clipped(triangle, p));
  const auto is_beyond = [&](const Vec3& side) {
    return std::all_of(p.begin(), p.begin() + count, [&](int corner) {
      return side.dot(view.corners[at(corner)].direction) > search_.outline.pyramid.slack;
    });
  };
  const std::vector<Vec3>& sides = search_.outline.pyramid.sides;
  if (std::any_of(sides.begin(), sides.end(), is_beyond)) return Cover::none;
  const int sign = view.face_sign(triangle);
  bool covers = true;
  for (std::size_t k = 0; k < count; ++k) {
    const int a = p[k], b = p[(k + 1) % count];
    bool separates = true;
    for (const OutlineEdge& edge : search_.outline.edges) {
      if (edge.from == a || edge.from == b) continue;
      const bool is_inside = view.turn(a, b, edge.from) == sign;
      covers = covers && is_inside;
      separates = separates && !is_inside;
      if (!covers && !separates) break;
    }
    if (separates) return Cover::none;
  }
  return covers ? Cover::all : Cover::some;
}

/// Finds the faces that may lie before the outline among those of the larger cell. True if one of
/// them hides it all.
bool VisibleCells::narrow(std::size_t depth) {
  faces_[depth + 1].clear();
  for (const int triangle : faces_[depth]) {
    const Cover cover = cover_by(triangle);
    if (cover == Cover::all) return true;
    if (cover == Cover::some) faces_[depth + 1].push_back(triangle);
  }
  return false;
}

bool VisibleCells::is_stuck(std::size_t depth) const {
  if (depth < cuts_to_tell) return false;
  return depth == deepest ||
         static_cast<double>(faces_[depth + 1].size()) >
             stuck * static_cast<double>(faces_[depth + 1 - cuts_to_tell].size());
}

void VisibleCells::look_at(const Query& query, const Cell& cell, std::size_t depth) {
  if (!make_outline(query, cell)) return search_.outline.forget(search_.view);
  if (narrow(depth)) {
    clear(query.part);
    search_.write_hidden(query.part);
    query.use(query.part);
    return search_.outline.forget(search_.view);
  }
  // What one face hides is left out of the count: most is known from the first face.
  work_ += faces_[depth + 1].size();
  if (faces_[depth + 1].size() > few_faces && !is_stuck(depth)) {
    search_.outline.forget(search_.view);
    return split(query, cell, depth);
  }
  arrange(query, cell, depth);
}

void VisibleCells::arrange(const Query& query, const Cell& cell, std::size_t depth) {
  PointView& view = search_.view;
  double jitter = 0;
  for (int attempt = 1;; ++attempt) {
    view.look_among(&faces_[depth + 1]);
    if (search_.arrange(false) == PartSearch::End::found || attempt == margins::most_attempts)
      break;
    jitter = next_jitter(jitter);
    view.start(query.point, query.normal, query.surface, jitter);
    if (!make_outline(query, cell)) break;
  }
  work_ += search_.arrangement.crossing_count();
  clear(query.part);
  search_.write(query.part);
  query.use(query.part);
  search_.outline.forget(view);
  if (jitter > 0) view.start(query.point, query.normal, query.surface);
}

/// In two, at the edge that looks longest, where it looks halved.
void VisibleCells::split(const Query& query, const Cell& cell, std::size_t depth) {
  std::array<double, 3> distance{};
  for (std::size_t k = 0; k < 3; ++k) distance[k] = (cell.corner[k] - query.point).norm();
  const auto cosine = [&](std::size_t k) {
    const std::size_t next = (k + 1) % 3;
    return (cell.corner[k] - query.point).dot(cell.corner[next] - query.point) /
           (distance[k] * distance[next]);
  };
  std::size_t a = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (cosine(k) < cosine(a)) a = k;
  const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
  const Vec3 middle = cell.corner[a] +
                      distance[a] / (distance[a] + distance[b]) * (cell.corner[b] - cell.corner[a]);
  look_at(query, {{cell.corner[a], middle, cell.corner[c]}, {cell.vertex[a], -1, cell.vertex[c]}},
          depth + 1);
  look_at(query, {{middle, cell.corner[b], cell.corner[c]}, {-1, cell.vertex[b], cell.vertex[c]}},
          depth + 1);
}

const std::vector<std::array<int, 3>>& VisibleCells::triangles_of(int id) {
  const OpaqueTopology& topology = search_.view.topology();
  triangles_.resize(topology.surfaces.size());
  std::vector<std::array<int, 3>>& triangles = triangles_[at(id)];
  if (!triangles.empty()) return triangles;
  const OpaqueTopology::OpaqueSurface& surface = topology.surfaces[at(id)];
  std::vector<Ring> images;
  std::vector<int> vertex;  // of each corner
  for (int r = surface.first_ring; r < surface.first_ring + surface.ring_count; ++r) {
    images.emplace_back();
    for (const OpaqueTopology::OutlineVertex& v : topology.ring(r)) {
      images.back().push_back(surface.frame.to_plane(topology.vertices[at(v.vertex)]));
      vertex.push_back(v.vertex);
    }
  }
  for (const auto& [a, b, c] : ring_triangles(images))
    triangles.push_back({vertex[at(a)], vertex[at(b)], vertex[at(c)]});
  return triangles;
}

std::size_t VisibleCells::run(const Vec3& point, const Vec3& normal, int surface, VisiblePart& part,
                              const std::function<void(const VisiblePart&)>& use) {
  PointView& view = search_.view;
  faces_.resize(deepest + 2);
  work_ = 0;
  view.start(point, normal, surface);
  if (!(view.distance() > view.slack()) || !search_.outline.make(view, point, normal, surface))
    return 0;
  collect_faces();
  work_ += faces_[0].size();
  search_.outline.forget(view);
  const Query query{point, normal, surface, part, use};
  for (const auto& vertex : triangles_of(surface)) {
    Cell cell;
    cell.vertex = vertex;
    for (std::size_t k = 0; k < 3; ++k) cell.corner[k] = view.topology().vertices[at(vertex[k])];
    look_at(query, cell, 0);
  }
  return work_;
}

}  // namespace halfshade
