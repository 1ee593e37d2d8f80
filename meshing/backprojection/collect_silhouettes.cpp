#include "meshing/backprojection/margins.h"
#include "meshing/backprojection/shadow_arrangement.h"
#include "meshing/geometry/stretch_in_box.h"

#include <algorithm>
#include <cmath>
#include <utility>

// The first step of the arrangement: which edges are silhouettes seen from the point.

namespace halfshade {
namespace {

/// Among fewer faces than these, silhouettes are found by looking at each; among more, by the tree
/// over edges.
constexpr std::size_t many_faces = 100;
/// So few faces are told apart by their corners sooner than by boxes.
constexpr int faces_of_leaf = 2;
/// All faces below a node look towards the eye, or all look away from it.
bool look_one_way(const NormalCone& cone, const Vec3& eye, double slack) {
  if (cone.axis.isZero()) return false;
  const Vec3 offset = eye - cone.centre;
  const double along = std::abs(cone.axis.dot(offset));
  const double across = std::sqrt(std::max(0., offset.squaredNorm() - along * along));
  return along * cone.cosine - across * cone.sine >
         cone.thickness * cone.cosine + cone.radius * cone.sine + slack;
}

}  // namespace

/// The faces that may come between point and emitter, or false if they are many.
bool ShadowArrangement::find_near_faces() {
  const FlatTree& faces = view_->face_tree();
  const auto beyond = [&](int vertex) { return view_->sides_beyond(vertex, outline_->pyramid); };
  int stack[FlatTree::max_stack];
  near_faces_.clear();
  for (const int start : view_->candidates().nodes) {
    int depth = 0;
    stack[depth++] = start;
    while (depth > 0) {
      const int index = stack[--depth];
      const FlatTree::Node& node = faces.nodes[at(index)];
      if (outline_->pyramid.is_outside(node.box)) continue;
      if (node.count > faces_of_leaf) {
        stack[depth++] = node.right;
        stack[depth++] = index + 1;
        continue;
      }
      for (int i = node.first; i < node.first + node.count; ++i) {
        const int face = faces.items[at(i)];
        const auto& corner = view_->topology().triangles[at(face)].corner;
        if ((beyond(corner[0]) & beyond(corner[1]) & beyond(corner[2])) != 0) continue;
        if (near_faces_.size() == many_faces) return false;
        near_faces_.push_back(face);
      }
    }
  }
  // How many were passed on the way depends on who narrowed the candidates down.
  view_->count_boxes(near_faces_.size());
  return true;
}

void ShadowArrangement::collect_silhouettes() {
  if (view_->among() == &near_faces_) return collect_near();
  if (view_->among() != nullptr) return collect_among(*view_->among());
  const SilhouetteTrees& trees = view_->silhouette_trees();
  const SightPyramid& pyramid = outline_->pyramid;
  const auto consider = [&](int edge) { consider_edge(edge); };
  walk_tree(
      trees.closed_edges,
      [&](int index) {
        const Bounds& box = trees.closed_edges.nodes[at(index)].box;
        view_->count_boxes();
        if (pyramid.is_outside(box)) return true;
        // Faces beyond the emitter's plane or in it do not count, so their edges may matter.
        return look_one_way(trees.cones[at(index)], pyramid.eye, pyramid.margin(box)) &&
               pyramid.is_before_plane(box);
      },
      consider);
  walk_tree(
      trees.open_edges,
      [&](int index) {
        view_->count_boxes();
        return pyramid.is_outside(trees.open_edges.nodes[at(index)].box);
      },
      consider);
  collect_cuts();
  put_in_order();
}

void ShadowArrangement::collect_near() {
  const OpaqueTopology& topology = view_->topology();
  const auto beyond = [&](int vertex) { return view_->sides_beyond(vertex, outline_->pyramid); };
  for (const int face : near_faces_)
    for (const int edge : topology.triangles[at(face)].edge) {
      const auto& e = topology.edges[at(edge)];
      if (view_->is_new(edge) && (beyond(e.from) & beyond(e.to)) == 0) consider_inside(edge);
    }
  for (const int face : near_faces_) collect_cuts_of(face);
  put_in_order();
}

/// The same where it is known which triangles count.
void ShadowArrangement::collect_among(const std::vector<int>& triangles) {
  near_edges_.clear();
  for (const int triangle : triangles)
    for (const int edge : view_->topology().triangles[at(triangle)].edge)
      near_edges_.push_back(edge);
  std::sort(near_edges_.begin(), near_edges_.end());
  near_edges_.erase(std::unique(near_edges_.begin(), near_edges_.end()), near_edges_.end());
  for (const int edge : near_edges_) consider_edge(edge);
  for (const int triangle : triangles) collect_cuts_of(triangle);
  put_in_order();
}

void ShadowArrangement::consider_edge(int edge) {
  const auto& e = view_->topology().edges[at(edge)];
  const int from = view_->corner_of_vertex(e.from), to = view_->corner_of_vertex(e.to);
  if (!outline_->pyramid.is_outside(view_->corners[at(from)].direction,
                                    view_->corners[at(to)].direction))
    consider_inside(edge);
}

/// An edge that is not clearly outside the pyramid.
void ShadowArrangement::consider_inside(int edge) {
  const auto& e = view_->topology().edges[at(edge)];
  int from = view_->corner_of_vertex(e.from), to = view_->corner_of_vertex(e.to);
  const PlaneSide a = view_->corners[at(from)].side, b = view_->corners[at(to)].side;
  if (a != PlaneSide::before && b != PlaneSide::before &&
      !(a == PlaneSide::on && b == PlaneSide::on))
    return;
  int weight = 0;
  for (int i = e.first; i < e.first + e.count; ++i) {
    const auto& incidence = view_->topology().incidences[at(i)];
    weight += incidence.direction * view_->face_sign(incidence.triangle);
  }
  if (weight == 0) return;
  if (a == PlaneSide::beyond) from = view_->corner_of_cut(edge);
  if (b == PlaneSide::beyond) to = view_->corner_of_cut(edge);
  if (weight > 0)
    add_arc(from, to, weight, EdgeId::edge(edge));
  else
    add_arc(to, from, -weight, EdgeId::edge(edge));
}

/// The lines where faces pierce the emitter's plane.
void ShadowArrangement::collect_cuts() {
  const FlatTree& faces = view_->face_tree();
  const SightPyramid& pyramid = outline_->pyramid;
  const auto skip = [&](int index) {
    const Bounds& box = faces.nodes[at(index)].box;
    view_->count_boxes();
    return !pyramid.crosses_plane(box) || pyramid.is_outside(box);
  };
  walk_tree(faces, skip, [&](int triangle) { collect_cuts_of(triangle); });
}

void ShadowArrangement::collect_cuts_of(int triangle) {
  const int sign = view_->face_sign(triangle);
  if (sign == 0) return;
  std::array<int, 4> p{};
  const int count = view_->clipped(triangle, p);
  for (int k = 0; k < count; ++k) {
    const int i = p[at(k)], j = p[at((k + 1) % count)];
    const Corner &a = view_->corners[at(i)], &b = view_->corners[at(j)];
    if (a.side != PlaneSide::on || b.side != PlaneSide::on || !(a.is_cut || b.is_cut)) continue;
    if (outline_->pyramid.is_outside(a.direction, b.direction)) continue;
    const EdgeId id = EdgeId::cut(triangle);
    sign > 0 ? add_arc(i, j, 1, id) : add_arc(j, i, 1, id);
  }
}

/// By what they are: so it does not matter in which way they were found.
void ShadowArrangement::put_in_order() {
  const auto silhouettes = arcs_.begin() + static_cast<std::ptrdiff_t>(outline_->edges.size());
  std::sort(silhouettes, arcs_.end(), [](const Arc& a, const Arc& b) { return a.edge < b.edge; });
  if (silhouettes != arcs_.end() && arcs_.back().edge.kind == EdgeId::Kind::cut) join_repeated();
}

/// Faces that overlap in one plane may share two edges, and then their cuts are one. Edges of the
/// scene are never repeated, but may lie in the emitter's plane, too.
void ShadowArrangement::join_repeated() {
  const auto ends = [&](const Arc& arc) {
    return std::minmax(view_->corners[at(arc.from)].rank, view_->corners[at(arc.to)].rank);
  };
  const auto silhouettes = arcs_.begin() + static_cast<std::ptrdiff_t>(outline_->edges.size());
  std::sort(silhouettes, arcs_.end(), [&](const Arc& a, const Arc& b) {
    const auto ends_a = ends(a), ends_b = ends(b);
    return ends_a != ends_b ? ends_a < ends_b : a.edge < b.edge;
  });
  auto kept = silhouettes;
  for (auto arc = silhouettes; arc != arcs_.end();) {
    Arc sum = *arc;
    for (++arc; arc != arcs_.end() && ends(*arc) == ends(sum); ++arc)
      sum.weight += arc->from == sum.from ? arc->weight : -arc->weight;
    if (sum.weight < 0) {
      std::swap(sum.from, sum.to);
      sum.weight = -sum.weight;
    }
    if (sum.weight != 0) *kept++ = sum;
  }
  arcs_.erase(kept, arcs_.end());
}

void ShadowArrangement::add_arc(int from, int to, int weight, EdgeId edge) {
  const auto& corners = view_->corners;
  // Where a silhouette is an edge of the outline, the outline speaks for both.
  if (corners[at(from)].next_on_outline == to || corners[at(to)].next_on_outline == from) return;
  Arc arc{from, to, weight, edge};
  if (set_box(arc)) arcs_.push_back(arc);
}

/// The bounding box in the emitter's plane of what lies in the outline's, both a little enlarged;
/// false if nothing does. Long edges reach far beyond a small emitter, and cross there what does
/// not matter.
bool ShadowArrangement::set_box(Arc& arc) const {
  const Corner &a = view_->corners[at(arc.from)], &b = view_->corners[at(arc.to)];
  const SightPyramid& pyramid = outline_->pyramid;
  const double margin = margins::box_margin * (pyramid.high - pyramid.low).maxCoeff() +
                        margins::blur_margin * view_->blur();
  const Vec2 low = pyramid.low.array() - margin, high = pyramid.high.array() + margin;
  if (!(a.is_ahead && b.is_ahead)) {
    arc.low = low;
    arc.high = high;
    return true;
  }
  const auto inside = stretch_in_box(a.image, b.image, low, high);
  if (!inside) return false;
  const Vec2 along = b.image - a.image, p = a.image + inside->first * along,
             q = a.image + inside->second * along;
  arc.low = p.cwiseMin(q).array() - margin;
  arc.high = p.cwiseMax(q).array() + margin;
  return true;
}

}  // namespace halfshade
