#include "meshing/curve_mesh.h"

#include "meshing/core/error.h"
#include "meshing/hull_inside.h"
#include "meshing/lazy_refinement.h"
#include "meshing/snap_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

namespace halfshade {
namespace {

// Corners of rings closer than this are one; of their size, and of their largest coordinate.
constexpr double weld_of_size = 1e-13, weld_of_coordinates = 32 * 0x1p-53;
// Snap distances of at least this many roundings of the largest coordinate make safe decisions.
constexpr double least_snap = 256 * 0x1p-53;
// If lines do not settle they are snapped more coarsely, this often and by this factor.
constexpr int most_attempts = 8;
constexpr double coarser = 8;
// Rounding of a midpoint and of the way back to space must not push an edge over the limit.
constexpr double length_margin = 1e-12;
// Of max_length: what `shortest` is held below, so that edges of the right length can be made.
constexpr double shortest_share = 0.25;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Box2 {
  Vec2 low = Vec2::Constant(HUGE_VAL), high = -low;
};

Box2 box_of(std::span<const Ring> rings) {
  Box2 box;
  for (const Ring& ring : rings)
    for (const Vec2& p : ring) {
      box.low = box.low.cwiseMin(p);
      box.high = box.high.cwiseMax(p);
    }
  return box;
}

double largest_coordinate(const Box2& box) {
  return box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).maxCoeff();
}

// The part of a segment in a box (Liang and Barsky 1984); ends inside stay as they are.
std::optional<Segment2> clip(const Segment2& segment, const Box2& box) {
  const Vec2 d = segment[1] - segment[0];
  double enter = 0, leave = 1;
  for (int k = 0; k < 2; ++k) {
    const double to_low = box.low[k] - segment[0][k], to_high = box.high[k] - segment[0][k];
    if (d[k] == 0) {
      if (to_low > 0 || to_high < 0) return {};
      continue;
    }
    enter = std::max(enter, std::min(to_low / d[k], to_high / d[k]));
    leave = std::min(leave, std::max(to_low / d[k], to_high / d[k]));
  }
  if (!(enter < leave)) return {};
  return Segment2{enter > 0 ? Vec2(segment[0] + enter * d) : segment[0],
                  leave < 1 ? Vec2(segment[0] + leave * d) : segment[1]};
}

// A piece of a line, as an edge of the graph.
struct Piece {
  Segment2 place;
  int id;
  int edge;
};

struct Drawing {
  SnapGraph graph;
  std::vector<std::pair<int, bool>> ring_edges;  // and whether the inside ends there
  std::vector<Piece> pieces;
};

void add_rings(Drawing& drawing, std::span<const Ring> rings, double weld) {
  std::vector<Vec2> points;
  std::vector<Link> segments;
  for (const Ring& ring : rings) {
    const int first = static_cast<int>(points.size()), n = static_cast<int>(ring.size());
    points.insert(points.end(), ring.begin(), ring.end());
    for (int k = 0; k < n; ++k) segments.push_back({first + k, first + (k + 1) % n});
  }
  const Arrangement arrangement = arrange(std::move(points), segments, {weld, weld});
  // A link that rings run along an even number of times has the same on both its sides.
  std::map<Link, bool> odd;
  for (const auto& chain : arrangement.chains)
    for (std::size_t k = 1; k < chain.size(); ++k) {
      bool& flag = odd[sorted_link(chain[k - 1], chain[k])];
      flag = !flag;
    }
  std::unordered_map<int, int> number;
  const auto fixed_point = [&](int p) {
    const auto [entry, is_new] = number.try_emplace(p, 0);
    if (is_new) entry->second = drawing.graph.add_fixed_point(arrangement.points[at(p)]);
    return entry->second;
  };
  for (const auto& [link, is_border] : odd) {
    const int a = fixed_point(link[0]), b = fixed_point(link[1]);
    drawing.ring_edges.emplace_back(drawing.graph.add_fixed_edge(a, b), is_border);
  }
}

struct Input {
  std::span<const Ring> rings;
  std::span<const Segment2> contacts;
  std::span<const CurveLine> lines;
};

// Everything in one graph; nothing if it does not settle.
std::optional<Drawing> draw(const Input& input, double snap) {
  Box2 box = box_of(input.rings);
  const double weld =
      weld_of_size * (box.high - box.low).norm() + weld_of_coordinates * largest_coordinate(box);
  Drawing drawing{SnapGraph(snap), {}, {}};
  add_rings(drawing, input.rings, weld);
  // Wide enough that ends made by clipping stay clear of the rings.
  const double margin = 8 * snap + 1e-3 * (box.high - box.low).norm();
  box.low.array() -= margin;
  box.high.array() += margin;
  for (const Segment2& contact : input.contacts)
    if (const auto part = clip(contact, box))
      drawing.graph.add_line((*part)[0], (*part)[1], std::min(weld, snap));
  if (!drawing.graph.settle()) return {};
  drawing.graph.freeze();
  for (const CurveLine& line : input.lines)
    for (std::size_t k = 1; k < line.points.size(); ++k)
      if (const auto part = clip({line.points[k - 1], line.points[k]}, box)) {
        const int edge = drawing.graph.add_line((*part)[0], (*part)[1]);
        if (edge >= 0)
          drawing.pieces.push_back({{line.points[k - 1], line.points[k]}, line.id, edge});
      }
  if (!drawing.graph.settle()) return {};
  return drawing;
}

std::optional<ConstrainedMesh> triangulate(const Drawing& drawing) {
  const auto& edges = drawing.graph.edges();
  std::vector<Link> links, border;
  for (const auto& edge : edges)
    if (edge.part_count == 0) links.push_back({edge.a, edge.b});
  for (const auto& [edge, is_border] : drawing.ring_edges)
    if (is_border)
      drawing.graph.for_each_part(edge, [&](int part) {
        border.push_back({edges[at(part)].a, edges[at(part)].b});
      });
  std::sort(border.begin(), border.end());
  HullTriangulation hull;
  try {
    hull = constrained_delaunay(drawing.graph.points(), links);
  } catch (const Error&) {
    return {};
  }
  const std::vector<bool> keep = inside(hull, border);
  std::vector<int> renamed(hull.triangles.size(), -1), point(drawing.graph.points().size(), -1);
  ConstrainedMesh mesh;
  for (std::size_t t = 0; t < keep.size(); ++t)
    if (keep[t]) {
      renamed[t] = static_cast<int>(mesh.triangles.size());
      mesh.triangles.emplace_back();
    }
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (!keep[t]) continue;
    auto& triangle = mesh.triangles[at(renamed[t])];
    for (std::size_t k = 0; k < 3; ++k) {
      const int p = hull.triangles[t][k];
      if (point[at(p)] < 0) {
        point[at(p)] = static_cast<int>(mesh.points.size());
        mesh.points.push_back(drawing.graph.points()[at(p)]);
      }
      triangle.corner[k] = point[at(p)];
      const int next = hull.neighbours[t][k];
      triangle.neighbour[k] = next < 0 ? -1 : renamed[at(next)];
      triangle.line[k] = drawing.graph.edge_between(p, hull.triangles[t][(k + 1) % 3]);
    }
  }
  return mesh;
}

double distance(const Vec2& p, const Segment2& s) {
  const Vec2 d = s[1] - s[0];
  const double squared = d.squaredNorm();
  const double t = squared > 0 ? std::clamp((p - s[0]).dot(d) / squared, 0.0, 1.0) : 0;
  return (s[0] + t * d - p).norm();
}

// Edges of the graph and the ids of the curves along them, sorted.
std::vector<std::pair<int, int>> curves_along(const Drawing& drawing) {
  std::vector<std::pair<int, int>> result;
  for (const Piece& piece : drawing.pieces)
    drawing.graph.for_each_part(piece.edge, [&](int part) { result.emplace_back(part, piece.id); });
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// Edges are straight, so that their ends are farthest from the line. Those outside do not count.
double deviation(const Drawing& drawing, const std::vector<bool>& is_used) {
  double largest = 0;
  const auto& graph = drawing.graph;
  for (const Piece& piece : drawing.pieces)
    graph.for_each_part(piece.edge, [&](int part) {
      if (!is_used[at(part)]) return;
      const auto& edge = graph.edges()[at(part)];
      for (const int p : {edge.a, edge.b})
        largest = std::max(largest, distance(graph.points()[at(p)], piece.place));
    });
  return largest;
}

CurveMesh assemble(const Drawing& drawing, const ConstrainedMesh& mesh) {
  CurveMesh result;
  result.mesh.points = mesh.points;
  std::vector<std::pair<Link, int>> constrained;
  std::vector<bool> is_used(drawing.graph.edges().size(), false);
  for (const auto& t : mesh.triangles) {
    result.mesh.triangles.push_back(t.corner);
    for (std::size_t k = 0; k < 3; ++k)
      if (t.line[k] >= 0) {
        constrained.emplace_back(sorted_link(t.corner[k], t.corner[(k + 1) % 3]), t.line[k]);
        is_used[at(t.line[k])] = true;
      }
  }
  std::sort(constrained.begin(), constrained.end());
  constrained.erase(std::unique(constrained.begin(), constrained.end()), constrained.end());
  const auto along = curves_along(drawing);
  result.curve_begin.push_back(0);
  for (const auto& [link, line] : constrained) {
    result.mesh.constrained_edges.push_back(link);
    result.is_d0.push_back(drawing.graph.edges()[at(line)].is_fixed);
    for (auto i = std::lower_bound(along.begin(), along.end(), std::pair(line, 0));
         i != along.end() && i->first == line; ++i)
      result.curves.push_back(i->second);
    result.curve_begin.push_back(static_cast<int>(result.curves.size()));
  }
  result.deviation = deviation(drawing, is_used);
  return result;
}

void check(const CurveMeshOptions& options) {
  const auto fail = [](const std::string& sentence) {
    throw Error(ErrorCode::contract, "mesh_with_curves", sentence);
  };
  const auto& [max_length, min_angle, max_triangles] = options.quality;
  if (!(max_length >= 0 && std::isfinite(max_length)))
    fail(fmt::format("max_length is {}; it must be finite and not negative", max_length));
  if (!(min_angle >= 0 && min_angle <= 20.7))
    fail(fmt::format("min_angle is {} degrees; it must lie in [0, 20.7]", min_angle));
  if (!(options.snap > 0 && std::isfinite(options.snap)))
    fail(fmt::format("snap is {}; it must be finite and positive", options.snap));
  if (!(options.shortest > options.snap && std::isfinite(options.shortest)))
    fail(fmt::format("shortest is {}; it must be finite and larger than snap, which is {}",
                     options.shortest, options.snap));
}

RefinementLimits limits_of(const CurveMeshOptions& options) {
  RefinementLimits limits;
  limits.max_length = options.quality.max_length * (1 - length_margin);
  limits.min_angle = options.quality.min_angle;
  limits.max_triangles = options.quality.max_triangles;
  limits.shortest = options.shortest;
  if (limits.max_length > 0)
    limits.shortest = std::min(limits.shortest, shortest_share * limits.max_length);
  return limits;
}

}  // namespace

CurveMesh mesh_with_curves(std::span<const Ring> rings, std::span<const Segment2> contacts,
                           std::span<const CurveLine> lines, const CurveMeshOptions& options) {
  check(options);
  double snap = std::max(options.snap, least_snap * largest_coordinate(box_of(rings)));
  for (int attempt = 0; attempt < most_attempts; ++attempt, snap *= coarser) {
    // In the end without the curves, which is known to go well.
    const bool is_last = attempt + 1 == most_attempts;
    const auto drawing = draw({rings, contacts, is_last ? lines.first(0) : lines}, snap);
    if (!drawing) continue;
    auto mesh = triangulate(*drawing);
    if (!mesh) continue;
    const bool is_complete = refine_lazily(*mesh, limits_of(options));
    CurveMesh result = assemble(*drawing, *mesh);
    result.mesh.complete = is_complete && !is_last;
    return result;
  }
  throw Error(ErrorCode::invalid_input, "mesh_with_curves",
              fmt::format("{} rings with {} contact lines could not be triangulated", rings.size(),
                          contacts.size()));
}

}  // namespace halfshade
