#include "meshing/events/emitter_scene.h"

#include "meshing/core/planar.h"
#include "meshing/events/emitter_border.h"
#include "meshing/events/rounding.h"
#include "meshing/events/silhouette_edges.h"
#include "meshing/geometry/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {

EmitterScene::EmitterScene(const SoundScene& scene, const OpaqueScene& opaque, int surface)
    : emitter(surface), frame(scene.surfaces[at(surface)].frame) {
  const OpaqueScene::Impl& impl = opaque.impl();
  slack = std::max(joined_share * scene.tolerance.length,
                   position_roundings * std::numeric_limits<double>::epsilon() * impl.magnitude);
  joined = std::max(slack, scene.tolerance.length);
  rings = scene.surfaces[at(surface)].rings;
  for (const std::size_t k : convex_hull(rings[0])) hull.push_back(rings[0][k]);
  for (const Vec2& p : hull) bounds.extend(p);
  area = halfshade::area(scene.surfaces[at(surface)]);
  const VertexHeights heights(impl, frame, slack);
  add_silhouettes(scene, impl, heights, *this);
  add_border(impl, heights, *this);
}

Line3 line_of(const EmitterScene& emitter_scene, const OpaqueScene::Impl& opaque, int edge) {
  if (edge >= 0 && edge < static_cast<int>(opaque.edges.size())) {
    const auto& ends = opaque.edges[at(edge)];
    const Vec3& from = opaque.vertices[at(ends.from)];
    return {from, opaque.vertices[at(ends.to)] - from};
  }
  for (const OutlinePiece& piece : emitter_scene.outline)
    if (piece.id == edge) return {piece.span.from, piece.span.direction()};
  return {emitter_scene.frame.origin, emitter_scene.frame.e1};
}

bool EmitterScene::may_be_silhouette(const SilhouetteEdge& edge, const Vec3& direction) const {
  int weight = 0;
  for (int f = edge.first_face; f < edge.first_face + edge.face_count; ++f) {
    const double side = faces[at(f)].normal.dot(direction);
    if (std::abs(side) <= grazing_sine) return true;
    weight += side > 0 ? faces[at(f)].direction : -faces[at(f)].direction;
  }
  return weight != 0;
}

bool EmitterScene::contains(const Vec3& point) const {
  const Vec2 p = frame.to_plane(point);
  return is_inside(rings, p) || distance_to_rings(rings, p) <= slack;
}

}  // namespace halfshade
