#pragma once

#include "meshing/backprojection/opaque_topology.h"
#include "meshing/backprojection/visible_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <compare>
#include <map>
#include <numeric>
#include <string>
#include <vector>

/// The structure of a visible part, as far as it tells the cells of the complete discontinuity mesh
/// apart, in a form that can be compared and printed.
namespace halfshade::test {

/// A place on the boundary of a visible part where one edge follows another. Edges that lie on one
/// line and share a vertex count as one: going over from one to the other changes nothing.
struct Junction {
  EdgeId from, to;  ///< the first of those on its line; of a cut the id is that of the face's plane
  auto operator<=>(const Junction&) const = default;
};

using Signature = std::vector<Junction>;  ///< sorted

/// What the exact signature of VisiblePart says, less
/// * which piece of a line, triangle of a polygon or polygon of a plane an edge belongs to;
/// * pieces no longer than rounding, which come and go where three edges meet in space.
/// Pieces that lie on the horizon belong to it whatever edge they are of.
class Signer {
 public:
  Signer(const SoundScene& scene, const OpaqueScene& opaque)
      : scene_(scene),
        opaque_(opaque),
        line_of_edge_(join_lines(opaque)),
        rounding_(1e-12 * scene.diagonal + 0x1p-46 * opaque.topology().magnitude) {}

  /// `normal`: of the surface that the point lies on.
  Signature operator()(const VisiblePart& part, const Vec3& point, const Vec3& normal,
                       int emitter) const {
    Signature signature;
    std::vector<EdgeId> chain;
    std::size_t first = 0;
    for (const int chain_end : part.chain_ends) {
      const auto end = static_cast<std::size_t>(chain_end);
      chain.clear();
      for (std::size_t i = first; i < end; ++i)
        if (const BoundaryPiece& piece = part.pieces[i]; (piece.to - piece.from).norm() > rounding_)
          chain.push_back(on_horizon(piece, point, normal) ? EdgeId::horizon()
                                                           : line(piece.edge, emitter));
      for (std::size_t i = 0; i < chain.size(); ++i)
        if (const Junction j{chain[i], chain[i + 1 < chain.size() ? i + 1 : 0]}; j.from != j.to)
          signature.push_back(j);
      first = end;
    }
    std::sort(signature.begin(), signature.end());
    return signature;
  }

  /// Unit normal of the plane through a point and a line.
  Vec3 plane_through(EdgeId line, int emitter, const Vec3& point) const {
    if (line.kind == EdgeId::Kind::cut) {  // where a surface's plane cuts the emitter's
      for (const Surface& r : scene_.surfaces)
        if (r.plane == line.id) {
          const PlaneFrame& light = scene_.surfaces[static_cast<std::size_t>(emitter)].frame;
          const Vec3 along = r.frame.normal.cross(light.normal);
          const Vec3 inwards = light.normal.cross(along);
          const Vec3 on =
              light.origin - r.frame.height(light.origin) / r.frame.normal.dot(inwards) * inwards;
          return (on - point).cross(along).normalized();
        }
    }
    const auto ends = ends_of(line, emitter);
    return (ends[0] - point).cross(ends[1] - ends[0]).normalized();
  }

  /// Name and ends, for messages.
  std::string describe(EdgeId line, int emitter) const {
    if (line == EdgeId::horizon()) return "horizon";
    if (line.kind == EdgeId::Kind::cut) return fmt::format("cut of plane {}", line.id);
    const auto [a, b] = ends_of(line, emitter);
    return fmt::format("{} {} ({:.10g}, {:.10g}, {:.10g}) ({:.10g}, {:.10g}, {:.10g})",
                       line.kind == EdgeId::Kind::emitter_edge ? "light edge" : "edge", line.id,
                       a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
  }

 private:
  bool on_horizon(const BoundaryPiece& piece, const Vec3& point, const Vec3& normal) const {
    return piece.edge == EdgeId::horizon() ||
           (std::abs(normal.dot(piece.from - point)) < rounding_ &&
            std::abs(normal.dot(piece.to - point)) < rounding_);
  }

  EdgeId line(EdgeId edge, int emitter) const {
    if (edge.kind == EdgeId::Kind::emitter_edge)
      return EdgeId::emitter_edge(line_of_outline(edge.id, emitter));
    if (edge.kind == EdgeId::Kind::edge) return EdgeId::edge(line_of_edge_[at(edge.id)]);
    const int surface = opaque_.topology().triangles[at(edge.id)].surface;
    return EdgeId::cut(scene_.surfaces[at(surface)].plane);
  }

  static bool straight_on(const Vec3& a, const Vec3& b, const Vec3& c) {
    constexpr double limit = 1e-9;  // sine of an angle that a planar mesh does not tell from 180°
    return (b - a).cross(c - b).norm() < limit * (b - a).norm() * (c - b).norm();
  }

  /// The first edge of the emitter's straight stretch.
  int line_of_outline(int edge, int emitter) const {
    int k = edge;
    for (const Ring& ring : scene_.surfaces[static_cast<std::size_t>(emitter)].rings) {
      const int count = static_cast<int>(ring.size());
      if (k >= count) {
        k -= count;
        continue;
      }
      const auto at = [&](int i) {
        const Vec2& p = ring[static_cast<std::size_t>((i + count) % count)];
        return Vec3(p.x(), p.y(), 0);
      };
      int start = k;
      while (start > k - count && straight_on(at(start - 1), at(start), at(start + 1))) --start;
      return edge + (start + count) % count - k;
    }
    return edge;
  }

  std::array<Vec3, 2> ends_of(EdgeId line, int emitter) const {
    if (line.kind == EdgeId::Kind::edge) return opaque_.edge_ends(line.id);
    const Surface& light = scene_.surfaces[static_cast<std::size_t>(emitter)];
    auto k = at(line.id);
    for (const Ring& ring : light.rings) {
      if (k < ring.size())
        return {light.frame.to_space(ring[k]), light.frame.to_space(ring[(k + 1) % ring.size()])};
      k -= ring.size();
    }
    return {};
  }

  /// The lowest edge of those on one line that share vertices.
  static std::vector<int> join_lines(const OpaqueScene& opaque) {
    const auto& edges = opaque.topology().edges;
    std::vector<std::vector<int>> at_vertex(opaque.topology().vertices.size());
    std::vector<int> line(edges.size());
    std::iota(line.begin(), line.end(), 0);
    const auto root = [&](int e) {
      while (line[static_cast<std::size_t>(e)] != e) e = line[static_cast<std::size_t>(e)];
      return e;
    };
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (const int v : {edges[e].from, edges[e].to})
        at_vertex[static_cast<std::size_t>(v)].push_back(static_cast<int>(e));
    const auto position = [&](int v) -> const Vec3& {
      return opaque.topology().vertices[static_cast<std::size_t>(v)];
    };
    const auto far_end = [&](int e, int v) {
      const auto& edge = edges[static_cast<std::size_t>(e)];
      return edge.from == v ? edge.to : edge.from;
    };
    for (std::size_t v = 0; v < at_vertex.size(); ++v)
      for (const int e : at_vertex[v])
        for (const int f : at_vertex[v]) {
          if (f <= e) continue;
          const int vertex = static_cast<int>(v);
          const Vec3& middle = position(vertex);
          const Vec3 &a = position(far_end(e, vertex)), &b = position(far_end(f, vertex));
          if (!straight_on(a, middle, b) || (middle - a).dot(b - middle) < 0) continue;
          const int i = root(e), j = root(f);
          line[static_cast<std::size_t>(std::max(i, j))] = std::min(i, j);
        }
    for (std::size_t e = 0; e < edges.size(); ++e) line[e] = root(static_cast<int>(e));
    return line;
  }

  const SoundScene& scene_;
  const OpaqueScene& opaque_;
  std::vector<int> line_of_edge_;
  double rounding_;  ///< of places where edges cross; a length
};

}  // namespace halfshade::test
