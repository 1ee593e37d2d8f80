#include "meshing/events/events.h"

#include "meshing/core/planar.h"
#include "meshing/events/margins.h"

#include <algorithm>
#include <array>
#include <cmath>

// Events with a vertex or a face: all lines of sight lie in a plane.

namespace halfshade {
namespace {

void normalize(std::vector<EdgeId>& group) {
  std::sort(group.begin(), group.end());
  group.erase(std::unique(group.begin(), group.end()), group.end());
}

std::vector<EdgeId> ids_at(const EmitterScene& emitter_scene, const SilhouetteVertex& vertex) {
  std::vector<EdgeId> ids;
  for (const int e : vertex.edges) ids.push_back(EdgeId::edge(emitter_scene.edges[at(e)].id));
  return ids;
}

/// How many of the silhouette edges at a vertex lie in the plane of a planar swath.
int count_in_plane(const EmitterScene& emitter_scene, const Swath& swath,
                   const SilhouetteVertex& vertex) {
  const Vec3 normal = plane_normal(swath);
  int count = 0;
  for (const int e : vertex.edges) {
    const SilhouetteEdge& edge = emitter_scene.edges[at(e)];
    if (std::abs(normal.dot(edge.whole.from - swath.apex)) <= edge.joined &&
        std::abs(normal.dot(edge.whole.to - swath.apex)) <= edge.joined)
      ++count;
  }
  return count;
}

/// Whether one of the outline's pieces at a corner lies in the swath's plane.
bool outline_in_plane(const EmitterScene& emitter_scene, const Swath& swath,
                      const OutlinePoint& corner) {
  const Vec3 normal = plane_normal(swath);
  for (const OutlinePiece& piece : emitter_scene.outline)
    if (std::find(corner.edges.begin(), corner.edges.end(), piece.id) != corner.edges.end() &&
        std::abs(normal.dot(piece.span.from - swath.apex)) <= emitter_scene.joined &&
        std::abs(normal.dot(piece.span.to - swath.apex)) <= emitter_scene.joined)
      return true;
  return false;
}

/// Where lines from a vertex through the points of a span meet the emitter's plane, if both lie in
/// front of it and the span stays on one side of the vertex: the image is straight.
std::array<Vec2, 2> image_of(const EmitterScene& emitter_scene, const Vec3& vertex, double height,
                             const Span3& span) {
  const auto project = [&](const Vec3& p) {
    const double drop = emitter_scene.frame.normal.dot(vertex - p);
    return emitter_scene.frame.to_plane(vertex + height / drop * (p - vertex));
  };
  return {project(span.from), project(span.to)};
}

/// False only if a segment misses the emitter's hull.
bool meets_hull(const EmitterScene& emitter_scene, const std::array<Vec2, 2>& segment) {
  double t0 = 0, t1 = 1;
  const Vec2 along = segment[1] - segment[0];
  for (std::size_t k = 0; k < emitter_scene.hull.size(); ++k) {
    const Vec2& a = emitter_scene.hull[k];
    const Vec2 side = emitter_scene.hull[(k + 1) % emitter_scene.hull.size()] - a;
    // inside: cross(side, p − a) ≥ 0
    const double from = cross_2d(side, segment[0] - a) + emitter_scene.slack * side.norm();
    const double slope = cross_2d(side, along);
    if (slope > 0)
      t0 = std::max(t0, -from / slope);
    else if (slope < 0)
      t1 = std::min(t1, -from / slope);
    else if (from < 0)
      return false;
  }
  return t0 <= t1;
}

/// In order, and perhaps others: those that a line from the emitter through a span can meet.
std::vector<int> vertices_on_lines_through(const EmitterScene& emitter_scene, const Span3& span) {
  const LinesThrough lines = emitter_scene.lines_through(span);
  std::vector<int> vertices;
  visit_reached(
      emitter_scene.vertex_tree, [&](const Bounds& box) { return lines.may_meet(box, 0); },
      [&](int vertex) { vertices.push_back(vertex); });
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

void non_emitter_swaths(const EmitterScene& emitter_scene, int edge, const SwathSink& sink) {
  const SilhouetteEdge& e = emitter_scene.edges[at(edge)];
  const Vec3& up = emitter_scene.frame.normal;
  for (const int w : vertices_on_lines_through(emitter_scene, e.front)) {
    const SilhouetteVertex& vertex = emitter_scene.vertices[at(w)];
    const double slack = std::max(margins::slack_at(vertex.position), margins::slack_of(e.whole));
    if (is_end(vertex.position, e.whole, slack) ||
        distance_to_line(vertex.position, e.whole) <= slack)
      continue;
    // The parts of the edge nearer to the emitter than the vertex, and farther from it.
    for (const double side : {-1., 1.}) {
      const double a = side * up.dot(e.front.from - vertex.position);
      const double b = side * up.dot(e.front.to - vertex.position);
      if (a <= slack && b <= slack) continue;
      Span3 part = e.front;
      if (a < slack) part.from = e.front.at((slack - a) / (b - a));
      if (b < slack) part.to = e.front.at((a - slack) / (a - b));
      if (!meets_hull(emitter_scene, image_of(emitter_scene, vertex.position, vertex.height, part)))
        continue;
      Swath swath;
      swath.source = {CurveKind::ev,
                      {Feature{Feature::Kind::vertex, vertex.id}, {Feature::Kind::edge, e.id}},
                      2};
      swath.apex = vertex.position;
      swath.base = part;
      swath.group = ids_at(emitter_scene, vertex);
      swath.group.push_back(EdgeId::edge(e.id));
      normalize(swath.group);
      swath.silhouettes[0] = edge;
      swath.corner = w;
      swath.may_be_first_order = count_in_plane(emitter_scene, swath, vertex) > 0;
      sink(swath);
    }
  }
}

}  // namespace

void edge_swaths(const EmitterScene& emitter_scene, int edge, const SwathSink& sink) {
  const SilhouetteEdge& e = emitter_scene.edges[at(edge)];
  for (const OutlinePoint& corner : emitter_scene.corners) {
    if (distance_to_line(corner.position, e.whole) <=
        std::max(emitter_scene.slack, margins::slack_of(e.whole)))
      continue;
    Swath swath;
    swath.source = {CurveKind::ev, {corner.feature, {Feature::Kind::edge, e.id}}, 2};
    swath.apex = corner.position;
    swath.base = e.front;
    swath.group = corner.edges;
    swath.group.push_back(EdgeId::edge(e.id));
    normalize(swath.group);
    swath.silhouettes[0] = edge;
    swath.ends_on_outline = true;
    swath.may_be_first_order = outline_in_plane(emitter_scene, swath, corner);
    sink(swath);
  }
  non_emitter_swaths(emitter_scene, edge, sink);
}

void vertex_swaths(const EmitterScene& emitter_scene, int vertex, const SwathSink& sink) {
  const SilhouetteVertex& w = emitter_scene.vertices[at(vertex)];
  for (const OutlinePiece& piece : emitter_scene.outline) {
    Swath swath;
    swath.source = {CurveKind::ev, {Feature{Feature::Kind::vertex, w.id}, piece.feature}, 2};
    swath.apex = w.position;
    swath.base = piece.span;
    swath.group = ids_at(emitter_scene, w);
    swath.group.push_back(piece.id);
    normalize(swath.group);
    swath.corner = vertex;
    swath.ends_on_outline = true;
    swath.may_be_first_order = count_in_plane(emitter_scene, swath, w) > 0;
    sink(swath);
  }
}

namespace {

/// A face and what of it can be seen edge-on.
struct FaceEdges {
  std::vector<Span3> spans;  // in front of the emitter
  std::vector<Vec3> ends;
  std::vector<EdgeId> ids;  // all on its border
};

FaceEdges edges_of_face(const EmitterScene& emitter_scene, const OpaqueTopology& opaque,
                        int receiver) {
  std::vector<int> count_once;
  for (const auto& triangle : opaque.triangles)
    if (triangle.surface == receiver)
      count_once.insert(count_once.end(), triangle.edge.begin(), triangle.edge.end());
  std::sort(count_once.begin(), count_once.end());
  FaceEdges face;
  for (std::size_t i = 0; i < count_once.size(); ++i) {
    const bool again = (i > 0 && count_once[i - 1] == count_once[i]) ||
                       (i + 1 < count_once.size() && count_once[i + 1] == count_once[i]);
    if (again) continue;
    face.ids.push_back(EdgeId::edge(count_once[i]));
    const auto& edge = opaque.edges[at(count_once[i])];
    Span3 span = {opaque.vertices[at(edge.from)], opaque.vertices[at(edge.to)]};
    const double a = emitter_scene.frame.height(span.from), b = emitter_scene.frame.height(span.to);
    const double slack = std::max(emitter_scene.slack, margins::slack_of(span));
    if (a <= slack && b <= slack) continue;
    for (const auto& [h, p] : {std::pair{a, span.from}, std::pair{b, span.to}})
      if (h > slack) face.ends.push_back(p);
    const Span3 whole = span;
    if (a < 0) span.from = whole.at(a / (a - b));
    if (b < 0) span.to = whole.at(a / (a - b));
    face.spans.push_back(span);
  }
  return face;
}

}  // namespace

void face_swaths(const SoundScene& scene, const EmitterScene& emitter_scene,
                 const OpaqueScene& opaque, int receiver, const SwathSink& sink) {
  const PlaneFrame& plane = scene.surfaces[at(receiver)].frame;
  std::vector<Vec3> entries;
  bool above = false, below = false;
  for (const OutlinePiece& piece : emitter_scene.outline) {
    const double a = plane.height(piece.span.from), b = plane.height(piece.span.to);
    above = above || std::max(a, b) > emitter_scene.slack;
    below = below || std::min(a, b) < -emitter_scene.slack;
    if ((a > 0) != (b > 0)) entries.push_back(piece.span.at(a / (a - b)));
  }
  if (!above || !below || entries.size() < 2) return;
  const FaceEdges face = edges_of_face(emitter_scene, opaque.topology(), receiver);
  if (face.spans.empty()) return;
  Swath swath;
  swath.source = {CurveKind::face, {Feature{Feature::Kind::face, receiver}}, 1};
  swath.group = face.ids;
  swath.may_be_first_order = true;
  const auto send = [&](const Vec3& apex, const Span3& base) {
    if (distance_to_line(apex, base) <= std::max(margins::slack_at(apex), margins::slack_of(base)))
      return;
    swath.apex = apex;
    swath.base = base;
    sink(swath);
  };
  const Vec3 along = plane.normal.cross(emitter_scene.frame.normal);
  const auto [first, last] = std::minmax_element(
      entries.begin(), entries.end(),
      [&](const Vec3& a, const Vec3& b) { return along.dot(a) < along.dot(b); });
  for (const Vec3& end : face.ends) send(end, {*first, *last});
  for (const Span3& span : face.spans) {
    for (const Vec3& entry : entries) send(entry, span);
    for (const SilhouetteEdge& edge : emitter_scene.edges) {
      const double a = plane.height(edge.front.from), b = plane.height(edge.front.to);
      const double slack = margins::slack_of(edge.front);
      const bool crosses = (a > slack && b < -slack) || (a < -slack && b > slack);
      if (crosses) send(edge.front.at(a / (a - b)), span);
    }
  }
}

}  // namespace halfshade
