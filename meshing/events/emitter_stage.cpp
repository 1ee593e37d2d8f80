#include "meshing/events/emitter_stage.h"

#include "meshing/core/error.h"
#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace halfshade {
namespace {

// Lines that run along a face to within this sine may have it on either side.
constexpr double grazing = 1e-9;
// What the repair has joined agrees to this share of the tolerance by which it joins.
constexpr double exact_share = 1e-3;
// Positions agree to this many roundings of the largest coordinate.
constexpr double position_roundings = 1e3;

/// Fills a stage step by step.
class Builder {
 public:
  Builder(const SoundScene& scene, const OpaqueTopology& opaque, EmitterStage& stage)
      : scene_(scene), opaque_(opaque), stage_(stage) {
    stage.stage_edge.assign(opaque.edges.size(), -1);
    for (const Vec3& p : opaque.vertices) height_.push_back(stage.frame.height(p));
  }

  void run() {
    for (int e = 0; e < static_cast<int>(opaque_.edges.size()); ++e) add_edge(e);
    add_vertices();
    add_own_outline();
    add_touching_edges();
    add_cuts();
    add_touching_points();
    add_outline_crossings();
  }

 private:
  bool is_on(int vertex) const { return std::abs(height_[at(vertex)]) <= stage_.slack; }
  bool is_in_front(int vertex) const { return height_[at(vertex)] > stage_.slack; }

  bool lies_in_emitter_plane(const OpaqueTopology::Triangle& triangle) const {
    return std::all_of(triangle.corner.begin(), triangle.corner.end(),
                       [&](int v) { return is_on(v); });
  }

  /// The faces at an edge, those in one plane taken together.
  void add_faces(const OpaqueTopology::Edge& edge, StageEdge& out) {
    std::map<int, StageEdge::Face> by_plane;
    for (int i = edge.first; i < edge.first + edge.count; ++i) {
      const OpaqueTopology::Incidence& incidence = opaque_.incidences[at(i)];
      const OpaqueTopology::Triangle& triangle = opaque_.triangles[at(incidence.triangle)];
      if (lies_in_emitter_plane(triangle)) continue;
      const Surface& receiver = scene_.surfaces[at(triangle.surface)];
      const auto [face, is_new] =
          by_plane.emplace(receiver.plane, StageEdge::Face{receiver.frame.normal, 0});
      const bool same_way = face->second.normal.dot(receiver.frame.normal) > 0;
      face->second.direction += same_way ? incidence.direction : -incidence.direction;
    }
    out.first_face = static_cast<int>(stage_.faces.size());
    for (const auto& [plane, face] : by_plane)
      if (face.direction != 0) stage_.faces.push_back(face);
    out.face_count = static_cast<int>(stage_.faces.size()) - out.first_face;
  }

  /// Whether the edge is a silhouette seen from some point of the emitter.
  bool is_capable(const StageEdge& edge) const {
    int weight = 0;
    for (int f = edge.first_face; f < edge.first_face + edge.face_count; ++f) {
      const StageEdge::Face& face = stage_.faces[at(f)];
      bool above = false, below = false;
      for (const Vec2& p : stage_.hull) {
        const double side = face.normal.dot(edge.whole.from - stage_.frame.to_space(p));
        above = above || side > -stage_.slack;
        below = below || side < stage_.slack;
      }
      if (above && below) return true;
      weight += above ? face.direction : -face.direction;
    }
    return weight != 0;
  }

  void add_edge(int id) {
    const OpaqueTopology::Edge& edge = opaque_.edges[at(id)];
    if (!is_in_front(edge.from) && !is_in_front(edge.to)) return;
    StageEdge out;
    out.id = id;
    out.whole = {opaque_.vertices[at(edge.from)], opaque_.vertices[at(edge.to)]};
    out.front = out.whole;
    const double a = height_[at(edge.from)], b = height_[at(edge.to)];
    if (a < -stage_.slack) out.front.from = out.whole.at(a / (a - b));
    if (b < -stage_.slack) out.front.to = out.whole.at(a / (a - b));
    const std::size_t faces = stage_.faces.size();
    add_faces(edge, out);
    if (out.face_count == 0 || !is_capable(out)) {
      stage_.faces.resize(faces);
      return;
    }
    stage_.stage_edge[at(id)] = static_cast<int>(stage_.edges.size());
    stage_.edges.push_back(out);
  }

  void add_vertices() {
    std::map<int, std::vector<int>> at_vertex;
    for (std::size_t e = 0; e < stage_.edges.size(); ++e) {
      const OpaqueTopology::Edge& edge = opaque_.edges[at(stage_.edges[e].id)];
      for (const int v : {edge.from, edge.to}) at_vertex[v].push_back(static_cast<int>(e));
    }
    for (const auto& [v, edges] : at_vertex)
      if (is_in_front(v))
        stage_.vertices.push_back({v, opaque_.vertices[at(v)], height_[at(v)], edges});
  }

  /// The corner at a vertex of the scene, which is made if need be.
  OutlinePoint& corner_at(int vertex, const Feature& feature) {
    const auto [entry, is_new] = corner_of_.emplace(vertex, stage_.corners.size());
    if (is_new) stage_.corners.push_back({opaque_.vertices[at(vertex)], {}, feature});
    return stage_.corners[entry->second];
  }

  void add_own_outline() {
    const OpaqueTopology::OpaqueSurface& surface = opaque_.surfaces[at(stage_.emitter)];
    for (int r = surface.first_ring; r < surface.first_ring + surface.ring_count; ++r) {
      const auto ring = opaque_.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const auto &here = ring[k], &next = ring[(k + 1) % ring.size()];
        const auto& before = ring[(k + ring.size() - 1) % ring.size()];
        const Vec3 &from = opaque_.vertices[at(here.vertex)],
                   &to = opaque_.vertices[at(next.vertex)];
        const EdgeId edge = EdgeId::emitter_edge(here.edge);
        stage_.outline.push_back({{from, to}, edge, feature_of(edge)});
        if (before.edge == here.edge) continue;
        OutlinePoint& corner = corner_at(here.vertex, {Feature::Kind::emitter_vertex, here.edge});
        corner.edges.push_back(EdgeId::emitter_edge(before.edge));
        corner.edges.push_back(edge);
      }
    }
  }

  /// Edges in the emitter's plane at which something that hangs from it begins.
  void add_touching_edges() {
    for (std::size_t e = 0; e < opaque_.edges.size(); ++e) {
      const OpaqueTopology::Edge& edge = opaque_.edges[e];
      if (!is_on(edge.from) || !is_on(edge.to)) continue;
      bool hangs = false;
      for (int i = edge.first; i < edge.first + edge.count; ++i)
        for (const int v : opaque_.triangles[at(opaque_.incidences[at(i)].triangle)].corner)
          hangs = hangs || is_in_front(v);
      const Span3 span = {opaque_.vertices[at(edge.from)], opaque_.vertices[at(edge.to)]};
      const EdgeId id = EdgeId::edge(static_cast<int>(e));
      if (hangs && meets_emitter(span)) stage_.outline.push_back({span, id, feature_of(id)});
    }
  }

  /// A box test: conservative.
  bool meets_emitter(const Span3& span) const {
    const Vec2 a = stage_.frame.to_plane(span.from), b = stage_.frame.to_plane(span.to);
    Vec2 low = stage_.hull[0], high = low;
    for (const Vec2& p : stage_.hull) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    return (a.cwiseMin(b).array() <= high.array() + stage_.slack).all() &&
           (a.cwiseMax(b).array() >= low.array() - stage_.slack).all();
  }

  /// Where faces pierce the emitter's plane.
  void add_cuts() {
    std::set<int> cut_edges;
    for (std::size_t t = 0; t < opaque_.triangles.size(); ++t) {
      const OpaqueTopology::Triangle& triangle = opaque_.triangles[t];
      std::vector<Vec3> ends;
      bool front = false, behind = false;
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = triangle.corner[k], b = triangle.corner[(k + 1) % 3];
        front = front || is_in_front(a);
        behind = behind || height_[at(a)] < -stage_.slack;
        if (is_on(a))
          ends.push_back(opaque_.vertices[at(a)]);
        else if (!is_on(b) && is_in_front(a) != is_in_front(b))
          ends.push_back(cut(triangle.edge[k]));
      }
      if (!front || !behind || ends.size() != 2 || !meets_emitter({ends[0], ends[1]})) continue;
      stage_.outline.push_back({{ends[0], ends[1]},
                                EdgeId::cut(static_cast<int>(t)),
                                {Feature::Kind::face, triangle.surface}});
      for (const int e : triangle.edge) {
        const OpaqueTopology::Edge& edge = opaque_.edges[at(e)];
        if (!is_on(edge.from) && !is_on(edge.to) && is_in_front(edge.from) != is_in_front(edge.to))
          cut_edges.insert(e);
      }
    }
    for (const int e : cut_edges) {
      const Vec3 position = cut(e);
      if (!stage_.contains(position)) continue;
      OutlinePoint corner{position, {EdgeId::edge(e)}, feature_of(EdgeId::edge(e))};
      const OpaqueTopology::Edge& edge = opaque_.edges[at(e)];
      for (int i = edge.first; i < edge.first + edge.count; ++i)
        corner.edges.push_back(EdgeId::cut(opaque_.incidences[at(i)].triangle));
      stage_.corners.push_back(std::move(corner));
    }
  }

  Vec3 cut(int e) const {
    const OpaqueTopology::Edge& edge = opaque_.edges[at(e)];
    const double a = height_[at(edge.from)], b = height_[at(edge.to)];
    const Vec3 from = opaque_.vertices[at(edge.from)];
    return from + a / (a - b) * (opaque_.vertices[at(edge.to)] - from);
  }

  /// Vertices in the emitter's plane from which edges lead away.
  void add_touching_points() {
    std::set<int> touching;
    for (const StageEdge& edge : stage_.edges) {
      const OpaqueTopology::Edge& ends = opaque_.edges[at(edge.id)];
      for (const int v : {ends.from, ends.to})
        if (is_on(v) && stage_.contains(opaque_.vertices[at(v)])) touching.insert(v);
    }
    for (const int v : touching) {
      OutlinePoint& corner = corner_at(v, {Feature::Kind::vertex, v});
      for (std::size_t e = 0; e < opaque_.edges.size(); ++e)
        if (opaque_.edges[e].from == v || opaque_.edges[e].to == v)
          corner.edges.push_back(EdgeId::edge(static_cast<int>(e)));
    }
  }

  /// Where what touches or cuts the plane crosses the emitter's border, or another such line.
  void add_outline_crossings() {
    for (std::size_t i = 0; i < stage_.outline.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const OutlinePiece &a = stage_.outline[i], &b = stage_.outline[j];
        if (a.id.is_of_outline() && b.id.is_of_outline()) continue;
        const Vec2 p = stage_.frame.to_plane(a.span.from), q = stage_.frame.to_plane(b.span.from);
        const Vec2 u = stage_.frame.to_plane(a.span.to) - p,
                   v = stage_.frame.to_plane(b.span.to) - q;
        const double d = cross_2d(u, v);
        const double s = cross_2d(q - p, v) / d, t = cross_2d(q - p, u) / d;
        if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1)) continue;
        stage_.corners.push_back({a.span.at(s), {a.id, b.id}, a.feature});
      }
  }

  const SoundScene& scene_;
  const OpaqueTopology& opaque_;
  EmitterStage& stage_;
  std::vector<double> height_;            // of vertices above the emitter's plane
  std::map<int, std::size_t> corner_of_;  // vertex of the scene → corner of the stage
};

}  // namespace

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vec2> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 &&
             cross_2d(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

EmitterStage::EmitterStage(const SoundScene& scene, const OpaqueScene& opaque, int receiver)
    : emitter(receiver), frame(scene.surfaces[at(receiver)].frame) {
  const OpaqueTopology& topology = opaque.topology();
  slack =
      std::max(exact_share * scene.tolerance.length,
               position_roundings * std::numeric_limits<double>::epsilon() * topology.magnitude);
  joined = std::max(slack, scene.tolerance.length);
  rings = scene.surfaces[at(receiver)].rings;
  hull = convex_hull(rings[0]);
  for (const Vec2& p : hull) bounds.extend(p);
  area = halfshade::area(scene.surfaces[at(receiver)]);
  Builder(scene, topology, *this).run();
  for (OutlinePoint& corner : corners) {
    std::sort(corner.edges.begin(), corner.edges.end());
    corner.edges.erase(std::unique(corner.edges.begin(), corner.edges.end()), corner.edges.end());
  }
}

namespace {

/// Where a triangle's plane cuts the emitter's; nothing if all its corners are on one side.
std::optional<Line3> line_of_cut(const EmitterStage& stage, const OpaqueTopology& opaque,
                                 const OpaqueTopology::Triangle& triangle) {
  std::array<double, 3> height{};
  std::array<Vec3, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = opaque.vertices[at(triangle.corner[k])];
    height[k] = stage.frame.height(corner[k]);
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

Line3 line_of(const EmitterStage& stage, const OpaqueTopology& opaque, EdgeId edge) {
  if (edge.kind == EdgeId::Kind::edge && at(edge.id) < opaque.edges.size()) {
    const auto& ends = opaque.edges[at(edge.id)];
    const Vec3& from = opaque.vertices[at(ends.from)];
    return {from, opaque.vertices[at(ends.to)] - from};
  }
  for (const OutlinePiece& piece : stage.outline)
    if (piece.id == edge) return {piece.span.from, piece.span.direction()};
  // A triangle that reaches through the plane by rounding only is no piece of the outline.
  if (edge.kind == EdgeId::Kind::cut && at(edge.id) < opaque.triangles.size())
    if (const auto line = line_of_cut(stage, opaque, opaque.triangles[at(edge.id)])) return *line;
  throw Error(ErrorCode::contract, "line_of",
              "there is no edge " + std::to_string(edge.id) + " of kind " +
                  std::to_string(static_cast<int>(edge.kind)));
}

bool EmitterStage::may_be_silhouette(const StageEdge& edge, const Vec3& direction) const {
  int weight = 0;
  for (int f = edge.first_face; f < edge.first_face + edge.face_count; ++f) {
    const double side = faces[at(f)].normal.dot(direction);
    if (std::abs(side) <= grazing) return true;
    weight += side > 0 ? faces[at(f)].direction : -faces[at(f)].direction;
  }
  return weight != 0;
}

bool EmitterStage::contains(const Vec3& point) const {
  const Vec2 p = frame.to_plane(point);
  return is_inside(rings, p) || distance_to_rings(rings, p) <= slack;
}

}  // namespace halfshade
