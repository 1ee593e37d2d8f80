#include "meshing/triangulation/curve_mesh.h"

#include "meshing/arrangement/triangles_inside.h"
#include "meshing/core/error.h"
#include "meshing/core/planar.h"
#include "meshing/triangulation/curve_drawing.h"
#include "meshing/triangulation/lazy_refinement.h"
#include "meshing/triangulation/margins.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace halfshade {
namespace {

// If curves do not settle they are snapped more coarsely, this often and by this factor.
constexpr int most_attempts = 8;
constexpr double coarser = 8;

// The triangles inside, numbered anew, with the points they use.
ConstrainedMesh cut_out(const HullTriangulation& hull, const std::vector<bool>& keep,
                        const SnapGraph& graph) {
  std::vector<int> renamed(hull.triangles.size(), -1), point(graph.points().size(), -1);
  int count = 0;
  for (std::size_t t = 0; t < keep.size(); ++t)
    if (keep[t]) renamed[t] = count++;
  ConstrainedMesh mesh;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (!keep[t]) continue;
    auto& triangle = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const int p = hull.triangles[t][k], next = hull.neighbours[t][k];
      if (point[at(p)] < 0) {
        point[at(p)] = static_cast<int>(mesh.points.size());
        mesh.points.push_back(graph.points()[at(p)]);
      }
      triangle.corner[k] = point[at(p)];
      triangle.neighbour[k] = next < 0 ? -1 : renamed[at(next)];
      triangle.constraint[k] = graph.edge_between(p, hull.triangles[t][(k + 1) % 3]);
    }
  }
  return mesh;
}

// The edges that the inside ends at. Where rings have become one, within rounding of a needle's
// tip, say, there is nothing between them.
std::vector<Link> border_of(const CurveDrawing& drawing) {
  std::vector<Link> all, border;
  for (const auto& [edge, is_border] : drawing.ring_edges)
    if (is_border)
      drawing.graph.for_each_part(edge, [&](int part) {
        const auto& e = drawing.graph.edges()[at(part)];
        all.push_back({e.a, e.b});
      });
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0, j = 0; i < all.size(); i = j) {
    while (j < all.size() && all[j] == all[i]) ++j;
    if ((j - i) % 2 == 1) border.push_back(all[i]);
  }
  return border;
}

// Nothing if edges cross after all.
std::optional<ConstrainedMesh> triangulate(const CurveDrawing& drawing) {
  std::vector<Link> links;
  for (const auto& edge : drawing.graph.edges())
    if (edge.part_count == 0) links.push_back({edge.a, edge.b});
  try {
    const HullTriangulation hull = constrained_delaunay(drawing.graph.points(), links);
    return cut_out(hull, triangles_inside(hull, border_of(drawing)), drawing.graph);
  } catch (const Error&) {
    return {};
  }
}

// Edges of the graph and the ids of the curves along them, sorted.
std::vector<std::pair<int, int>> curves_along(const CurveDrawing& drawing) {
  std::vector<std::pair<int, int>> result;
  for (const CurveDrawing::Piece& piece : drawing.pieces)
    drawing.graph.for_each_part(piece.edge, [&](int part) { result.emplace_back(part, piece.id); });
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// Edges are straight, so that their ends are farthest from the curve. Those outside do not count.
double deviation(const CurveDrawing& drawing, const std::vector<bool>& is_used) {
  double largest = 0;
  const auto& graph = drawing.graph;
  for (const CurveDrawing::Piece& piece : drawing.pieces)
    graph.for_each_part(piece.edge, [&](int part) {
      if (!is_used[at(part)]) return;
      const auto& edge = graph.edges()[at(part)];
      for (const int p : {edge.a, edge.b})
        largest = std::max(largest, distance_to_segment(graph.points()[at(p)], piece.segment[0],
                                                        piece.segment[1]));
    });
  return largest;
}

CurveMesh assemble(const CurveDrawing& drawing, const ConstrainedMesh& mesh) {
  CurveMesh result;
  result.mesh.points = mesh.points;
  std::vector<std::pair<Link, int>> constrained;
  std::vector<bool> is_used(drawing.graph.edges().size(), false);
  for (const auto& t : mesh.triangles) {
    auto& corners = result.mesh.triangles.emplace_back(t.corner);
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    for (std::size_t k = 0; k < 3; ++k)
      if (t.constraint[k] >= 0) {
        constrained.emplace_back(sorted_link(t.corner[k], t.corner[(k + 1) % 3]), t.constraint[k]);
        is_used[at(t.constraint[k])] = true;
      }
  }
  std::sort(result.mesh.triangles.begin(), result.mesh.triangles.end());
  std::sort(constrained.begin(), constrained.end());
  constrained.erase(std::unique(constrained.begin(), constrained.end()), constrained.end());
  const auto along = curves_along(drawing);
  result.curve_begin.push_back(0);
  for (const auto& [link, id] : constrained) {
    result.mesh.constrained_edges.push_back(link);
    result.is_d0.push_back(drawing.graph.edges()[at(id)].is_fixed);
    for (auto i = std::lower_bound(along.begin(), along.end(), std::pair(id, 0));
         i != along.end() && i->first == id; ++i)
      result.curves.push_back(i->second);
    result.curve_begin.push_back(static_cast<int>(result.curves.size()));
  }
  result.deviation = deviation(drawing, is_used);
  return result;
}

[[noreturn]] void fail(const std::string& sentence) {
  throw Error(ErrorCode::contract, "mesh_with_curves", sentence);
}

void check(std::span<const CurvePolyline> curves) {
  for (const CurvePolyline& curve : curves) {
    if (curve.id < 0)
      fail(fmt::format("a curve has the id {}; ids must not be negative", curve.id));
    for (const Vec2& p : curve.points)
      if (!p.allFinite()) fail(fmt::format("a point of curve {} is not finite", curve.id));
  }
}

void check(const CurveMeshOptions& options) {
  const auto& [max_length, min_angle, max_triangles] = options.quality;
  if (!(max_length >= 0 && std::isfinite(max_length)))
    fail(fmt::format("max_length is {}; it must be finite and not negative", max_length));
  if (!(min_angle >= 0 && min_angle <= delaunay_angle))
    fail(fmt::format("min_angle is {} degrees; it must lie in [0, {}]", min_angle, delaunay_angle));
  if (!(options.snap > 0 && std::isfinite(options.snap)))
    fail(fmt::format("snap is {}; it must be finite and positive", options.snap));
  if (!(options.shortest > options.snap && std::isfinite(options.shortest)))
    fail(fmt::format("shortest is {}; it must be finite and larger than snap, which is {}",
                     options.shortest, options.snap));
}

RefinementLimits limits_of(const CurveMeshOptions& options) {
  RefinementLimits limits;
  limits.max_length = options.quality.max_length * (1 - margins::length);
  limits.min_angle = options.quality.min_angle;
  limits.max_triangles = options.quality.max_triangles;
  limits.shortest = options.shortest;
  if (limits.max_length > 0)
    limits.shortest = std::min(limits.shortest, margins::shortest * limits.max_length);
  return limits;
}

}  // namespace

CurveMesh mesh_with_curves(std::span<const Ring> rings, std::span<const Segment2> contacts,
                           std::span<const CurvePolyline> curves, const CurveMeshOptions& options) {
  check(options);
  check(curves);
  if (rings.empty()) {
    CurveMesh nothing;
    nothing.curve_begin = {0};
    return nothing;
  }
  double snap = std::max(options.snap, least_safe_snap(rings));
  for (int attempt = 0; attempt < most_attempts; ++attempt, snap *= coarser) {
    // In the end without the curves, which is known to go well.
    const bool is_last = attempt + 1 == most_attempts;
    const auto drawing = draw_curves({rings, contacts, is_last ? curves.first(0) : curves}, snap);
    if (!drawing) continue;
    auto mesh = triangulate(*drawing);
    if (!mesh) continue;
    const bool is_complete = refine_lazily(*mesh, limits_of(options));
    CurveMesh result = assemble(*drawing, *mesh);
    result.mesh.complete = is_complete && !is_last;
    return result;
  }
  throw Error(ErrorCode::invalid_input, {},
              fmt::format("{} rings with {} contact lines could not be triangulated", rings.size(),
                          contacts.size()));
}

}  // namespace halfshade
