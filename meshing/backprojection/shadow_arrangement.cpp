#include "meshing/backprojection/shadow_arrangement.h"

#include <algorithm>
#include <cmath>

// The third step of the arrangement: how many layers of faces lie over the directions beside each
// stretch of an arc. Their number is found exactly for a few directions and counted on from there,
// crossing by crossing.

namespace halfshade {
namespace {

/// A view with more layers of faces than these is crowded.
constexpr int many_layers = 4;

}  // namespace

bool ShadowArrangement::build(PointView& view, const EmitterOutline& outline, bool unless_crowded) {
  view_ = &view;
  outline_ = &outline;
  pieces.clear();
  arcs_.clear();
  is_consistent = true;
  for (const OutlineEdge& edge : outline.edges) {
    Arc arc{edge.from, edge.to, 1, edge.edge};
    arc.is_outline = true;
    set_box(arc);
    arcs_.push_back(arc);
  }
  if (view.among() == nullptr && find_near_faces()) view.look_among(&near_faces_);
  first_layers_ = view.layers_over({arcs_[0].from, arcs_[0].to, 1});
  for (const int surface : view.layer_surfaces())
    if (is_hidden_by(surface)) {
      crossings_.clear();
      fully_lit = false;
      junction_count = 0;
      return true;
    }
  if (unless_crowded && first_layers_ > many_layers) return false;
  collect_silhouettes();
  if (arcs_.size() == outline.edges.size()) {  // all is seen, or all is hidden
    crossings_.clear();
    fully_lit = first_layers_ == 0;
    junction_count = 0;
    return true;
  }
  if (!find_crossings(unless_crowded)) return false;
  meetings_.assign(view.corners.size(), {});
  for (std::size_t i = outline.edges.size(); i < arcs_.size(); ++i) {
    ++meetings_[at(arcs_[i].to)].in;
    Meeting& start = meetings_[at(arcs_[i].from)];
    ++start.out;
    start.next = static_cast<int>(i);
  }
  sort_crossings();
  walk_outline();
  const std::size_t lit = pieces.size();
  walk_silhouettes();
  fully_lit = lit == outline.edges.size() && pieces.size() == lit;
  for (std::size_t i = 0; fully_lit && i < lit; ++i)
    fully_lit = pieces[i].start == junction_of(outline.edges[i].from) &&
                pieces[i].end == junction_of(outline.edges[i].to);
  junction_count = junction_of(static_cast<int>(view.corners.size()));
  return true;
}

/// Whether a surface that lies over a direction in the pyramid lies over all: its border stays
/// outside, and all of the outline lies clearly behind its plane, or all of it before the
/// emitter's.
bool ShadowArrangement::is_hidden_by(int id) {
  const auto& surface = view_->topology().surfaces[at(id)];
  bool is_before = true;
  for (int r = surface.first_ring; r < surface.first_ring + surface.ring_count; ++r) {
    const auto ring = view_->topology().ring(r);
    int from = view_->corner_of_vertex(ring.back().vertex);
    for (const auto& next : ring) {
      const int to = view_->corner_of_vertex(next.vertex);
      is_before = is_before && view_->corners[at(to)].side != PlaneSide::beyond;
      if (!passes_outline(from, to)) return false;
      from = to;
    }
  }
  return is_before || is_outline_behind(surface);
}

/// Whether an edge stays outside the outline, if it is convex: some line separates them then.
bool ShadowArrangement::passes_outline(int from, int to) const {
  const auto& corners = view_->corners;
  if (outline_->pyramid.is_outside(corners[at(from)].direction, corners[at(to)].direction))
    return true;
  int side = 0;
  for (const OutlineEdge& edge : outline_->edges) {
    if (edge.from == from || edge.from == to) continue;
    const int turn = view_->turn(from, to, edge.from);
    if (turn == 0 || turn == -side) return false;
    side = turn;
  }
  return true;
}

/// Whether sight lines to the outline meet a surface's plane before they end.
bool ShadowArrangement::is_outline_behind(const OpaqueTopology::OpaqueSurface& surface) const {
  const double margin = surface.tolerance.length + view_->blur();
  const double height = surface.frame.height(view_->point());
  return std::all_of(outline_->edges.begin(), outline_->edges.end(), [&](const OutlineEdge& edge) {
    const double beyond = surface.frame.height(view_->corners[at(edge.from)].true_position);
    return height > 0 ? beyond < -margin : beyond > margin;
  });
}

Vec3 ShadowArrangement::position(const Arc& arc, double along) const {
  const Vec3 &from = view_->corners[at(arc.from)].true_position,
             &to = view_->corners[at(arc.to)].true_position;
  return along <= 0 ? from : along >= 1 ? to : from + along * (to - from);
}

/// Adds a stretch of an arc with so many layers on its right, if it bounds the visible part.
void ShadowArrangement::emit(const Arc& arc, std::array<double, 2> along,
                             std::array<int, 2> junctions, int layers) {
  const bool right = layers == 0, left = layers + arc.weight == 0;
  if (arc.is_outline ? !right : right == left) return;
  ArrangedPiece piece{position(arc, along[0]), position(arc, along[1]), arc.edge, junctions[0],
                      junctions[1]};
  if (right && !arc.is_outline) {
    std::swap(piece.from, piece.to);
    std::swap(piece.start, piece.end);
  }
  pieces.push_back(piece);
}

void ShadowArrangement::walk_outline() {
  int layers = 0, reached = -1;
  for (std::size_t i = 0; i < outline_->edges.size(); ++i) {
    const int id = static_cast<int>(i);
    const Arc arc = arcs_[i];
    const Meeting& meeting = meetings_[at(arc.from)];
    // Just inside; the count carries over from the edge before unless silhouettes meet here.
    if (i == 0)
      layers = first_layers_;
    else if (reached != arc.from || meeting.in + meeting.out > 0)
      layers = view_->layers_over({arc.from, arc.to, 1});
    double from = 0;
    int junction = junction_of(arc.from);
    for (int k = arc.first; k < arc.first + arc.count; ++k) {
      Crossing& crossing = crossings_[at(order_[at(k)])];
      const std::size_t side = at(side_of(crossing, id));
      const int next = order_[at(k)];
      emit(arc, {from, crossing.along[side]}, {junction, next}, layers);
      crossing.layers = std::min(layers, layers + crossing.step[side]);
      layers += crossing.step[side];
      is_consistent = is_consistent && layers >= 0;
      from = crossing.along[side];
      junction = next;
    }
    emit(arc, {from, 1}, {junction, junction_of(arc.to)}, layers);
    reached = arc.to;
  }
}

bool ShadowArrangement::enters_first(const Arc& arc) const {
  const int id = static_cast<int>(&arc - arcs_.data());
  for (int k = arc.first; k < arc.first + arc.count; ++k) {
    const Crossing& crossing = crossings_[at(order_[at(k)])];
    const int side = side_of(crossing, id);
    if (arcs_[at(crossing.arc[at(1 - side)])].is_outline) return crossing.step[at(side)] > 0;
  }
  return false;
}

bool ShadowArrangement::is_inside(const DirectionBeside& direction) const {
  const int apex = outline_->edges[0].from;
  int sum = 0;
  for (const OutlineEdge& edge : outline_->edges)
    if (edge.from != apex && edge.to != apex)
      sum += view_->winding(apex, edge.from, edge.to, direction);
  return sum > 0;
}

void ShadowArrangement::walk_silhouettes() {
  const int first = static_cast<int>(outline_->edges.size());
  const int count = static_cast<int>(arcs_.size());
  for (int i = first; i < count; ++i)
    if (!arcs_[at(i)].is_done && enters_first(arcs_[at(i)])) walk_chain(i, false, 0);
  for (int i = first; i < count; ++i) {
    if (arcs_[at(i)].is_done) continue;
    const DirectionBeside direction{arcs_[at(i)].from, arcs_[at(i)].to, -1};
    const bool inside = is_inside(direction);
    walk_chain(i, inside, inside ? view_->layers_over(direction) : 0);
  }
}

/// Walks an arc and those that continue it, as long as the way leads on inside without a fork.
void ShadowArrangement::walk_chain(int arc, bool inside, int layers) {
  while (true) {
    inside = walk_arc(arc, inside, layers);
    if (!inside) return;
    const int end = arcs_[at(arc)].to;
    const Meeting& meeting = meetings_[at(end)];
    if (meeting.in != 1 || meeting.out != 1 || view_->corners[at(end)].next_on_outline >= 0) return;
    const Arc& next = arcs_[at(meeting.next)];
    if (next.weight != arcs_[at(arc)].weight) return;
    if (next.is_done) {
      is_consistent = is_consistent && next.start_layers == layers;
      return;
    }
    arc = meeting.next;
  }
}

/// Walks one arc; `layers` are those on its right. Returns whether its end is inside the outline.
bool ShadowArrangement::walk_arc(int id, bool inside, int& layers) {
  Arc& arc = arcs_[at(id)];
  arc.is_done = true;
  arc.start_layers = layers;
  double from = 0;
  int junction = junction_of(arc.from);
  for (int k = arc.first; k < arc.first + arc.count; ++k) {
    const Crossing& crossing = crossings_[at(order_[at(k)])];
    const int side = side_of(crossing, id);
    const int next = order_[at(k)], step = crossing.step[at(side)];
    const double to = crossing.along[at(side)];
    if (inside) emit(arc, {from, to}, {junction, next}, layers);
    from = to;
    junction = next;
    if (arcs_[at(crossing.arc[at(1 - side)])].is_outline) {
      is_consistent =
          is_consistent && inside == (step < 0) && (!inside || layers == crossing.layers);
      inside = step > 0;
      layers = crossing.layers;
    } else if (inside) {
      layers += step;
      is_consistent = is_consistent && layers >= 0;
    }
  }
  if (inside) emit(arc, {from, 1}, {junction, junction_of(arc.to)}, layers);
  return inside;
}

}  // namespace halfshade
