#include "meshing/triangulation/planar_mesh.h"

#include "meshing/arrangement/arrangement.h"
#include "meshing/arrangement/triangles_inside.h"
#include "meshing/core/error.h"
#include "meshing/triangulation/delaunay_refinement.h"
#include "meshing/triangulation/length_bisection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace halfshade {
namespace {

// Relative to the polygon's size: far above rounding, far below anything anyone draws.
constexpr double relative_snap = 1e-13;
// Rounding of a midpoint and of the way back to space must not push an edge over the limit.
constexpr double length_margin = 1e-12;

double extent(std::span<const Ring> rings) {
  Vec2 low = Vec2::Constant(HUGE_VAL), high = -low;
  for (const Ring& ring : rings)
    for (const Vec2& p : ring) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  return (high - low).norm() + high.cwiseAbs().cwiseMax(low.cwiseAbs()).maxCoeff();
}

struct Outline {
  std::vector<Vec2> points;
  std::vector<Link> links;   // sorted
  std::vector<Link> border;  // those that the inside ends at; sorted
};

Outline outline(std::span<const Ring> rings, std::span<const Segment2> contacts) {
  std::vector<Vec2> points;
  std::vector<Link> segments;
  for (const Ring& ring : rings) {
    const int first = static_cast<int>(points.size()), n = static_cast<int>(ring.size());
    points.insert(points.end(), ring.begin(), ring.end());
    for (int k = 0; k < n; ++k) segments.push_back({first + k, first + (k + 1) % n});
  }
  const std::size_t ring_segments = segments.size();
  for (const Segment2& contact : contacts) {
    segments.push_back({static_cast<int>(points.size()), static_cast<int>(points.size()) + 1});
    points.insert(points.end(), contact.begin(), contact.end());
  }
  const double snap = relative_snap * extent(rings);
  const Arrangement arrangement = arrange(std::move(points), segments, {snap, snap});
  // A link that rings run along an even number of times has the same on both its sides.
  std::map<Link, bool> odd;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto& chain = arrangement.chains[s];
    for (std::size_t k = 1; k < chain.size(); ++k) {
      bool& flag = odd[sorted_link(chain[k - 1], chain[k])];
      flag = flag != (s < ring_segments);
    }
  }
  Outline result;
  result.points = arrangement.points;
  for (const auto& [link, is_border] : odd) {
    result.links.push_back(link);
    if (is_border) result.border.push_back(link);
  }
  return result;
}

// Leaves out points that no triangle uses, and links that lie outside.
PlanarMesh compact(const PlanarMesh& mesh) {
  PlanarMesh result;
  result.complete = mesh.complete;
  std::vector<int> renamed(mesh.points.size(), -1);
  for (const auto& triangle : mesh.triangles)
    for (const int p : triangle) renamed[static_cast<std::size_t>(p)] = 0;
  for (std::size_t p = 0; p < renamed.size(); ++p)
    if (renamed[p] == 0) {
      renamed[p] = static_cast<int>(result.points.size());
      result.points.push_back(mesh.points[p]);
    }
  std::vector<Link> edges;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<int, 3> t = {renamed[static_cast<std::size_t>(a)],
                                  renamed[static_cast<std::size_t>(b)],
                                  renamed[static_cast<std::size_t>(c)]};
    result.triangles.push_back(t);
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(sorted_link(t[k], t[(k + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  for (const auto& [a, b] : mesh.constrained_edges) {
    const Link link =
        sorted_link(renamed[static_cast<std::size_t>(a)], renamed[static_cast<std::size_t>(b)]);
    if (link[0] >= 0 && std::binary_search(edges.begin(), edges.end(), link))
      result.constrained_edges.push_back(link);
  }
  std::sort(result.constrained_edges.begin(), result.constrained_edges.end());
  return result;
}

PlanarMesh triangulate(const Outline& outline) {
  const HullTriangulation hull = constrained_delaunay(outline.points, outline.links);
  const std::vector<bool> keep = triangles_inside(hull, outline.border);
  PlanarMesh mesh;
  mesh.points = outline.points;
  mesh.constrained_edges = outline.links;
  for (std::size_t t = 0; t < keep.size(); ++t)
    if (keep[t]) mesh.triangles.push_back(hull.triangles[t]);
  return compact(mesh);
}

void check(const PlanarMeshOptions& options) {
  if (!(options.max_length >= 0 && std::isfinite(options.max_length)))
    throw Error(
        ErrorCode::contract, "refine_triangulation",
        fmt::format("max_length is {}; it must be finite and not negative", options.max_length));
  if (!(options.min_angle >= 0 && options.min_angle <= 20.7))
    throw Error(
        ErrorCode::contract, "refine_triangulation",
        fmt::format("min_angle is {} degrees; it must lie in [0, 20.7]", options.min_angle));
}

}  // namespace

PlanarMesh triangulate(std::span<const Ring> rings, std::span<const Segment2> contacts) {
  return triangulate(outline(rings, contacts));
}

PlanarMesh refine_triangulation(std::span<const Ring> rings, std::span<const Segment2> contacts,
                                const PlanarMeshOptions& options) {
  check(options);
  PlanarMeshOptions inner = options;
  inner.max_length = options.max_length * (1 - length_margin);
  const PlanarMesh coarse = triangulate(outline(rings, contacts));
  if (auto refined = delaunay_refinement(coarse, inner)) {
    bisect_long_edges(*refined, inner.max_length, inner.max_triangles);
    return compact(*refined);
  }
  PlanarMesh mesh = coarse;
  bisect_long_edges(mesh, inner.max_length, inner.max_triangles);
  mesh.complete = false;
  return mesh;
}

}  // namespace halfshade
