#include "meshing/events/emitter_scene.h"

#include "meshing/core/error.h"
#include "meshing/core/planar.h"
#include "meshing/events/emitter_border.h"
#include "meshing/events/margins.h"
#include "meshing/events/silhouette_edges.h"
#include "meshing/geometry/convex_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace halfshade {
namespace {

Bounds box_with_slack(const Span3& span) {
  return bounds_of(span.from, span.to).grown(margins::slack_of(span));
}

}  // namespace

EmitterScene::EmitterScene(const SoundScene& scene, const OpaqueScene& opaque, int surface,
                           const std::vector<bool>& among)
    : emitter(surface), frame(scene.surfaces[at(surface)].frame) {
  const OpaqueTopology& topology = opaque.topology();
  const OpaqueTopology::OpaqueSurface& own = topology.surfaces[at(surface)];
  slack = margins::position_roundings * std::numeric_limits<double>::epsilon() * own.magnitude;
  joined = std::max(slack, own.tolerance.length);
  rings = scene.surfaces[at(surface)].rings;
  for (const std::size_t k : convex_hull(rings[0])) hull.push_back(rings[0][k]);
  for (const Vec2& p : hull) {
    bounds.extend(p);
    box.include(frame.to_space(p));
  }
  box = box.grown(2 * slack);
  area = halfshade::area(scene.surfaces[at(surface)]);
  const VertexHeights heights(topology, frame, slack);
  add_silhouettes(scene, topology, heights, among, *this);
  add_border(topology, heights, *this);
  std::vector<Bounds> boxes;
  for (const SilhouetteEdge& edge : edges) boxes.push_back(box_with_slack(edge.front));
  edge_tree = make_tight_tree(boxes);
  boxes.clear();
  for (const SilhouetteVertex& vertex : vertices)
    boxes.push_back(box_with_slack({vertex.position, vertex.position}));
  vertex_tree = make_tight_tree(boxes);
}

LinesThrough EmitterScene::lines_through(const Span3& span) const {
  return {box, box_with_slack(span)};
}

namespace {

/// Where a triangle's plane cuts the emitter's; nothing if all its corners are on one side.
std::optional<Line3> line_of_cut(const EmitterScene& emitter_scene, const OpaqueTopology& opaque,
                                 const OpaqueTopology::Triangle& triangle) {
  std::array<double, 3> height{};
  std::array<Vec3, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = opaque.vertices[at(triangle.corner[k])];
    height[k] = emitter_scene.frame.height(corner[k]);
  }
  for (std::size_t k = 0; k < 3; ++k) {  // the corner that is alone on its side
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    if ((height[i] > 0) != (height[j] > 0) || (height[i] > 0) == (height[k] > 0)) continue;
    const auto cut = [&](std::size_t other) -> Vec3 {
      return corner[k] + height[k] / (height[k] - height[other]) * (corner[other] - corner[k]);
    };
    return Line3{cut(i), cut(j) - cut(i)};
  }
  return std::nullopt;
}

}  // namespace

Line3 line_of(const EmitterScene& emitter_scene, const OpaqueTopology& opaque, EdgeId edge) {
  if (edge.kind == EdgeId::Kind::edge && at(edge.id) < opaque.edges.size()) {
    const auto [from, to] = opaque.ends(opaque.edges[at(edge.id)]);
    return {from, to - from};
  }
  for (const OutlinePiece& piece : emitter_scene.outline)
    if (piece.id == edge) return {piece.span.from, piece.span.direction()};
  // A triangle that reaches through the plane by rounding only is no piece of the outline.
  if (edge.kind == EdgeId::Kind::cut && at(edge.id) < opaque.triangles.size())
    if (const auto line = line_of_cut(emitter_scene, opaque, opaque.triangles[at(edge.id)]))
      return *line;
  throw Error(ErrorCode::contract, "line_of",
              "there is no edge " + std::to_string(edge.id) + " of kind " +
                  std::to_string(static_cast<int>(edge.kind)));
}

bool EmitterScene::may_be_silhouette(const SilhouetteEdge& edge, const Vec3& direction) const {
  int weight = 0;
  for (int f = edge.first_face; f < edge.first_face + edge.face_count; ++f) {
    const double side = faces[at(f)].normal.dot(direction);
    if (std::abs(side) <= margins::grazing_sine) return true;
    weight += side > 0 ? faces[at(f)].direction : -faces[at(f)].direction;
  }
  return weight != 0;
}

bool EmitterScene::contains(const Vec3& point) const {
  const Vec2 p = frame.to_plane(point);
  return is_inside(rings, p) || distance_to_rings(rings, p) <= slack;
}

}  // namespace halfshade
