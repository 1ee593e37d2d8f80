#include "meshing/events/emitter_border.h"

#include "meshing/core/planar.h"
#include "meshing/events/margins.h"

#include <algorithm>
#include <map>
#include <set>

namespace halfshade {
namespace {

class BorderSearch {
 public:
  BorderSearch(const OpaqueTopology& opaque, const VertexHeights& heights, EmitterScene& out)
      : opaque_(opaque), heights_(heights), out_(out) {}

  void add_own_outline() {
    const OpaqueTopology::OpaqueSurface& surface = opaque_.surfaces[at(out_.emitter)];
    for (int r = surface.first_ring; r < surface.first_ring + surface.ring_count; ++r) {
      const auto ring = opaque_.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const auto &here = ring[k], &next = ring[(k + 1) % ring.size()];
        const auto& before = ring[(k + ring.size() - 1) % ring.size()];
        const Vec3 &from = opaque_.vertices[at(here.vertex)],
                   &to = opaque_.vertices[at(next.vertex)];
        const EdgeId edge = EdgeId::emitter_edge(here.edge);
        out_.outline.push_back({{from, to}, edge, feature_of(edge)});
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
      if (!heights_.is_on(edge.from) || !heights_.is_on(edge.to)) continue;
      bool hangs = false;
      for (int i = edge.first; i < edge.first + edge.count; ++i)
        for (const int v : opaque_.triangles[at(opaque_.incidences[at(i)].triangle)].corner)
          hangs = hangs || heights_.is_in_front(v);
      const Span3 span = {opaque_.vertices[at(edge.from)], opaque_.vertices[at(edge.to)]};
      const EdgeId id = EdgeId::edge(static_cast<int>(e));
      if (hangs && meets_emitter(span)) out_.outline.push_back({span, id, feature_of(id)});
    }
  }

  /// Where faces pierce the emitter's plane.
  void add_cuts() {
    std::set<int> cut_edges;
    for (std::size_t t = 0; t < opaque_.triangles.size(); ++t) {
      const OpaqueTopology::Triangle& triangle = opaque_.triangles[t];
      if (!pierces_plane(triangle)) continue;
      const std::vector<Vec3> ends = ends_in_plane(triangle);
      if (ends.size() != 2 || !meets_emitter({ends[0], ends[1]})) continue;
      out_.outline.push_back({{ends[0], ends[1]},
                              EdgeId::cut(static_cast<int>(t)),
                              {Feature::Kind::face, triangle.surface}});
      for (const int e : triangle.edge)
        if (is_cut(opaque_.edges[at(e)].from, opaque_.edges[at(e)].to)) cut_edges.insert(e);
    }
    for (const int e : cut_edges) {
      const Vec3 position = cut(e);
      if (!out_.contains(position)) continue;
      OutlinePoint corner{position, {EdgeId::edge(e)}, feature_of(EdgeId::edge(e))};
      const OpaqueTopology::Edge& edge = opaque_.edges[at(e)];
      for (int i = edge.first; i < edge.first + edge.count; ++i)
        corner.edges.push_back(EdgeId::cut(opaque_.incidences[at(i)].triangle));
      out_.corners.push_back(std::move(corner));
    }
  }

  /// Vertices in the emitter's plane from which edges lead away.
  void add_touching_points() {
    std::set<int> touching;
    for (const SilhouetteEdge& edge : out_.edges) {
      const OpaqueTopology::Edge& ends = opaque_.edges[at(edge.id)];
      for (const int v : {ends.from, ends.to})
        if (heights_.is_on(v) && out_.contains(opaque_.vertices[at(v)])) touching.insert(v);
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
    for (std::size_t i = 0; i < out_.outline.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const OutlinePiece &a = out_.outline[i], &b = out_.outline[j];
        if (a.id.is_of_outline() && b.id.is_of_outline()) continue;
        const Vec2 p = out_.frame.to_plane(a.span.from), q = out_.frame.to_plane(b.span.from);
        const Vec2 u = out_.frame.to_plane(a.span.to) - p, v = out_.frame.to_plane(b.span.to) - q;
        const double d = cross_2d(u, v);
        const double s = cross_2d(q - p, v) / d, t = cross_2d(q - p, u) / d;
        if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1)) continue;
        out_.corners.push_back({a.span.at(s), {a.id, b.id}, a.feature});
      }
  }

 private:
  /// The corner at a vertex of the scene, which is made if need be.
  OutlinePoint& corner_at(int vertex, const Feature& feature) {
    const auto [entry, is_new] = corner_of_.emplace(vertex, out_.corners.size());
    if (is_new) out_.corners.push_back({opaque_.vertices[at(vertex)], {}, feature});
    return out_.corners[entry->second];
  }

  /// A box test: conservative.
  bool meets_emitter(const Span3& span) const {
    const Vec2 a = out_.frame.to_plane(span.from), b = out_.frame.to_plane(span.to);
    const double slack = std::max(out_.slack, margins::slack_of(span));
    return (a.cwiseMin(b).array() <= out_.bounds.max().array() + slack).all() &&
           (a.cwiseMax(b).array() >= out_.bounds.min().array() - slack).all();
  }

  bool pierces_plane(const OpaqueTopology::Triangle& triangle) const {
    const auto& corners = triangle.corner;
    const auto is_in_front = [&](int v) { return heights_.is_in_front(v); };
    const auto is_behind = [&](int v) { return heights_.is_behind(v); };
    return std::any_of(corners.begin(), corners.end(), is_in_front) &&
           std::any_of(corners.begin(), corners.end(), is_behind);
  }

  /// Whether the edge between two vertices runs from one side of the emitter's plane to the other.
  bool is_cut(int from, int to) const {
    return !heights_.is_on(from) && !heights_.is_on(to) &&
           heights_.is_in_front(from) != heights_.is_in_front(to);
  }

  /// Where the border of a triangle meets the emitter's plane.
  std::vector<Vec3> ends_in_plane(const OpaqueTopology::Triangle& triangle) const {
    std::vector<Vec3> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = triangle.corner[k], b = triangle.corner[(k + 1) % 3];
      if (heights_.is_on(a))
        ends.push_back(opaque_.vertices[at(a)]);
      else if (is_cut(a, b))
        ends.push_back(cut(triangle.edge[k]));
    }
    return ends;
  }

  /// Where an edge cuts the emitter's plane.
  Vec3 cut(int e) const {
    const OpaqueTopology::Edge& edge = opaque_.edges[at(e)];
    const double a = heights_.height(edge.from), b = heights_.height(edge.to);
    const Vec3 from = opaque_.vertices[at(edge.from)];
    return from + a / (a - b) * (opaque_.vertices[at(edge.to)] - from);
  }

  const OpaqueTopology& opaque_;
  const VertexHeights& heights_;
  EmitterScene& out_;
  std::map<int, std::size_t> corner_of_;  // vertex of the scene → corner
};

}  // namespace

void add_border(const OpaqueTopology& opaque, const VertexHeights& heights, EmitterScene& out) {
  BorderSearch search(opaque, heights, out);
  search.add_own_outline();
  search.add_touching_edges();
  search.add_cuts();
  search.add_touching_points();
  search.add_outline_crossings();
  for (OutlinePoint& corner : out.corners) {
    std::sort(corner.edges.begin(), corner.edges.end());
    corner.edges.erase(std::unique(corner.edges.begin(), corner.edges.end()), corner.edges.end());
  }
}

}  // namespace halfshade
