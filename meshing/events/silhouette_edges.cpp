#include "meshing/events/silhouette_edges.h"

#include "meshing/events/margins.h"

#include <algorithm>
#include <map>

namespace halfshade {
namespace {

class SilhouetteSearch {
 public:
  SilhouetteSearch(const SoundScene& scene, const OpaqueTopology& opaque,
                   const VertexHeights& heights, EmitterScene& out)
      : scene_(scene), opaque_(opaque), heights_(heights), out_(out) {}

  void add_edge(int id) {
    const OpaqueTopology::Edge& edge = opaque_.edges[at(id)];
    if (!heights_.is_in_front(edge.from) && !heights_.is_in_front(edge.to)) return;
    SilhouetteEdge silhouette;
    silhouette.id = id;
    silhouette.whole = {opaque_.vertices[at(edge.from)], opaque_.vertices[at(edge.to)]};
    silhouette.front = silhouette.whole;
    silhouette.joined = std::max(edge.joined, margins::slack_of(silhouette.whole));
    const double a = heights_.height(edge.from), b = heights_.height(edge.to);
    if (heights_.is_behind(edge.from)) silhouette.front.from = silhouette.whole.at(a / (a - b));
    if (heights_.is_behind(edge.to)) silhouette.front.to = silhouette.whole.at(a / (a - b));
    const std::size_t faces = out_.faces.size();
    add_faces(edge, silhouette);
    if (silhouette.face_count == 0 || !is_capable(silhouette)) {
      out_.faces.resize(faces);
      return;
    }
    out_.edges.push_back(silhouette);
  }

  void add_vertices() {
    std::map<int, std::vector<int>> at_vertex;
    for (std::size_t e = 0; e < out_.edges.size(); ++e) {
      const OpaqueTopology::Edge& edge = opaque_.edges[at(out_.edges[e].id)];
      for (const int v : {edge.from, edge.to}) at_vertex[v].push_back(static_cast<int>(e));
    }
    for (const auto& [v, edges] : at_vertex)
      if (heights_.is_in_front(v))
        out_.vertices.push_back({v, opaque_.vertices[at(v)], heights_.height(v), edges});
  }

 private:
  /// The faces at an edge, those in one plane taken together.
  void add_faces(const OpaqueTopology::Edge& edge, SilhouetteEdge& silhouette) {
    std::map<int, SilhouetteEdge::Face> by_plane;
    for (int i = edge.first; i < edge.first + edge.count; ++i) {
      const OpaqueTopology::Incidence& incidence = opaque_.incidences[at(i)];
      const OpaqueTopology::Triangle& triangle = opaque_.triangles[at(incidence.triangle)];
      if (lies_in_emitter_plane(triangle)) continue;
      const Surface& receiver = scene_.surfaces[at(triangle.surface)];
      const auto [face, is_new] =
          by_plane.emplace(receiver.plane, SilhouetteEdge::Face{receiver.frame.normal, 0});
      const bool same_way = face->second.normal.dot(receiver.frame.normal) > 0;
      face->second.direction += same_way ? incidence.direction : -incidence.direction;
    }
    silhouette.first_face = static_cast<int>(out_.faces.size());
    for (const auto& [plane, face] : by_plane)
      if (face.direction != 0) out_.faces.push_back(face);
    silhouette.face_count = static_cast<int>(out_.faces.size()) - silhouette.first_face;
  }

  /// Whether the edge is a silhouette seen from some point of the emitter.
  bool is_capable(const SilhouetteEdge& edge) const {
    int weight = 0;
    const double slack = std::max(out_.slack, margins::slack_of(edge.whole));
    for (int f = edge.first_face; f < edge.first_face + edge.face_count; ++f) {
      const SilhouetteEdge::Face& face = out_.faces[at(f)];
      bool above = false, below = false;
      for (const Vec2& p : out_.hull) {
        const double side = face.normal.dot(edge.whole.from - out_.frame.to_space(p));
        above = above || side > -slack;
        below = below || side < slack;
      }
      if (above && below) return true;
      weight += above ? face.direction : -face.direction;
    }
    return weight != 0;
  }

  bool lies_in_emitter_plane(const OpaqueTopology::Triangle& triangle) const {
    return std::all_of(triangle.corner.begin(), triangle.corner.end(),
                       [&](int v) { return heights_.is_on(v); });
  }

  const SoundScene& scene_;
  const OpaqueTopology& opaque_;
  const VertexHeights& heights_;
  EmitterScene& out_;
};

bool belongs_to_some(const OpaqueTopology& opaque, const OpaqueTopology::Edge& edge,
                     const std::vector<bool>& among) {
  for (int i = edge.first; i < edge.first + edge.count; ++i)
    if (among[at(opaque.triangles[at(opaque.incidences[at(i)].triangle)].surface)]) return true;
  return false;
}

}  // namespace

void add_silhouettes(const SoundScene& scene, const OpaqueTopology& opaque,
                     const VertexHeights& heights, const std::vector<bool>& among,
                     EmitterScene& out) {
  SilhouetteSearch search(scene, opaque, heights, out);
  for (int e = 0; e < static_cast<int>(opaque.edges.size()); ++e)
    if (among.empty() || belongs_to_some(opaque, opaque.edges[at(e)], among)) search.add_edge(e);
  search.add_vertices();
}

}  // namespace halfshade
