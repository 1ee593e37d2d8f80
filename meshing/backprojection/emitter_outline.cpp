#include "meshing/backprojection/emitter_outline.h"

#include "meshing/backprojection/margins.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halfshade {
/// Above the horizon, which is raised by a few roundings: so edges of other faces that lie in the
/// plane of the surface the point is on, as those of its own neighbours do, are clearly below it.
double EmitterOutline::height(const PointView& view, int corner) const {
  const double h = normal_.dot(view.corners[at(corner)].true_position - point_) -
                   margins::raised_horizon * view.slack();
  return std::abs(h) <= view.slack() ? 0 : h;
}

void EmitterOutline::add_edge(PointView& view, int from, int to, EdgeId edge) {
  if (from == to) return;
  edges.push_back({from, to, edge});
  view.corners[at(from)].next_on_outline = to;
}

/// The corner where an edge between two sides of the horizon crosses it.
int EmitterOutline::cross_horizon(PointView& view, int from, int to) {
  const double a = height(view, from), b = height(view, to);
  if (a == 0) return from;
  if (b == 0) return to;
  const Vec3 p = view.corners[at(from)].true_position, q = view.corners[at(to)].true_position;
  return view.add_corner(p + a / (a - b) * (q - p));
}

void EmitterOutline::cut_ring(PointView& view,
                              std::span<const OpaqueTopology::OutlineVertex> ring) {
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const int a = view.corner_of_vertex(ring[k].vertex);
    const int b = view.corner_of_vertex(ring[(k + 1) % ring.size()].vertex);
    cut_edge(view, a, b, EdgeId::emitter_edge(ring[k].edge));
  }
}

void EmitterOutline::cut_edge(PointView& view, int a, int b, EdgeId edge) {
  const double from = height(view, a), to = height(view, b);
  reaches_above_ = reaches_above_ || from > 0;
  if (from >= 0 && to >= 0) return add_edge(view, a, b, edge);
  if (from < 0 && to < 0) return;
  const int c = cross_horizon(view, a, b);
  const double along = horizon_.dot(view.corners[at(c)].true_position - point_);
  if (from >= 0) {
    add_edge(view, a, c, edge);
    exits_.push_back({along, c});
  } else {
    add_edge(view, c, b, edge);
    entries_.push_back({along, c});
  }
}

/// Along the horizon, exits and entries take turns.
void EmitterOutline::close_along_horizon(PointView& view) {
  const auto before = [](const Crossing& a, const Crossing& b) {
    return a.along != b.along ? a.along < b.along : a.corner < b.corner;
  };
  std::sort(exits_.begin(), exits_.end(), before);
  std::sort(entries_.begin(), entries_.end(), before);
  for (std::size_t i = 0; i < exits_.size(); ++i)
    add_edge(view, exits_[i].corner, entries_[i].corner, EdgeId::horizon());
}

/// Chain by chain, each edge after the one that ends where it starts.
void EmitterOutline::put_in_order(const PointView& view) {
  unordered_.swap(edges);
  edges.clear();
  first_at_.assign(view.corners.size(), -1);
  sibling_.assign(unordered_.size(), -1);
  for (std::size_t e = unordered_.size(); e-- > 0;) {
    int& first = first_at_[at(unordered_[e].from)];
    sibling_[e] = first;
    first = static_cast<int>(e);
  }
  for (const OutlineEdge& start : unordered_)
    for (int corner = start.from; first_at_[at(corner)] >= 0;) {
      const int e = first_at_[at(corner)];
      first_at_[at(corner)] = sibling_[at(e)];
      edges.push_back(unordered_[at(e)]);
      corner = unordered_[at(e)].to;
    }
}

void EmitterOutline::start_pyramid(const PointView& view) {
  const PlaneFrame& frame = view.emitter();
  pyramid.eye = point_;
  pyramid.normal = frame.normal;
  pyramid.plane_point = frame.origin;
  pyramid.slack = margins::pyramid_margin * view.blur();
  pyramid.spread = pyramid.slack / view.magnitude();
  pyramid.low = pyramid.high = view.corners[at(edges[0].from)].image;
  for (const OutlineEdge& edge : edges) {
    pyramid.low = pyramid.low.cwiseMin(view.corners[at(edge.from)].image);
    pyramid.high = pyramid.high.cwiseMax(view.corners[at(edge.from)].image);
  }
  pyramid.sides.assign(1, frame.normal);
}

/// Through a line in the emitter's plane, so far from the point's foot.
void EmitterOutline::add_side(const PointView& view, const Vec3& out, double inset) {
  pyramid.sides.push_back((view.distance() * out + inset * view.emitter().normal).normalized());
}

void EmitterOutline::add_side_along(const PointView& view, const OutlineEdge& edge) {
  const PlaneFrame& frame = view.emitter();
  // Seen from the front the outline runs counter-clockwise, so outwards is to the right.
  const Vec2 along = view.corners[at(edge.to)].image - view.corners[at(edge.from)].image;
  const Vec2 out = Vec2(along.y(), -along.x()).normalized();
  double limit = -HUGE_VAL;
  for (const OutlineEdge& other : edges)
    limit = std::max(limit, out.dot(view.corners[at(other.from)].image));
  add_side(view, out.x() * frame.e1 + out.y() * frame.e2, limit);
}

const std::vector<BorderLine>& EmitterOutline::lines_of(const OpaqueTopology& topology,
                                                        int surface) {
  lines_.resize(topology.surfaces.size());
  std::vector<BorderLine>& lines = lines_[at(surface)];
  if (lines.empty()) lines = border_lines(topology, surface);
  return lines;
}

void EmitterOutline::copy_ends(std::vector<int>& ends) const {
  ends.clear();
  std::size_t first = 0;
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges[e].to == edges[first].from) {
      first = e + 1;
      ends.push_back(static_cast<int>(first));
    }
}

void EmitterOutline::start(const PointView& view, const Vec3& point, const Vec3& normal) {
  edges.clear();
  exits_.clear();
  entries_.clear();
  reaches_above_ = false;
  point_ = point;
  normal_ = normal;
  horizon_ = normal.cross(view.emitter().normal);
}

/// False if nothing is left.
bool EmitterOutline::close(PointView& view) {
  if (!reaches_above_ || edges.empty() || exits_.size() != entries_.size()) return false;
  if (!exits_.empty()) {
    close_along_horizon(view);
    put_in_order(view);
  }
  start_pyramid(view);
  return true;
}

/// The pyramid's sides are those of the whole emitter, wherever the horizon cuts it, and one along
/// the horizon: so what lies outside for several points together is outside for each of them.
bool EmitterOutline::make(PointView& view, const Vec3& point, const Vec3& normal, int emitter) {
  start(view, point, normal);
  const auto& surface = view.topology().surfaces[at(emitter)];
  for (int r = surface.first_ring; r < surface.first_ring + surface.ring_count; ++r)
    cut_ring(view, view.topology().ring(r));
  if (!close(view)) return false;
  for (const BorderLine& line : lines_of(view.topology(), emitter))
    add_side(view, line.out, line.inset(view.emitter(), point));
  for (const OutlineEdge& edge : edges)
    if (edge.edge == EdgeId::horizon()) {
      add_side_along(view, edge);
      break;
    }
  pyramid.make_planes();
  return true;
}

bool EmitterOutline::make(PointView& view, const Vec3& point, const Vec3& normal,
                          const std::array<int, 3>& corners) {
  start(view, point, normal);
  for (std::size_t k = 0; k < 3; ++k)
    cut_edge(view, corners[k], corners[(k + 1) % 3], EdgeId::emitter_edge(static_cast<int>(k)));
  if (!close(view)) return false;
  for (const OutlineEdge& edge : edges) add_side_along(view, edge);
  pyramid.make_planes();
  return true;
}

void EmitterOutline::forget(PointView& view) const {
  for (const OutlineEdge& edge : edges) view.corners[at(edge.from)].next_on_outline = -1;
}

}  // namespace halfshade
