#include "meshing/triangulation/curve_drawing.h"

#include "meshing/arrangement/arrangement.h"
#include "meshing/arrangement/triangles_inside.h"
#include "meshing/geometry/stretch_in_box.h"
#include "meshing/triangulation/margins.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace halfshade {
namespace {

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

// The part of a segment in a box; ends inside stay as they are.
std::optional<Segment2> clip(const Segment2& segment, const Box2& box) {
  const auto stretch = stretch_in_box(segment[0], segment[1], box.low, box.high);
  if (!stretch || !(stretch->first < stretch->second)) return {};
  const Vec2 d = segment[1] - segment[0];
  return Segment2{stretch->first > 0 ? Vec2(segment[0] + stretch->first * d) : segment[0],
                  stretch->second < 1 ? Vec2(segment[0] + stretch->second * d) : segment[1]};
}

void add_rings(CurveDrawing& drawing, std::span<const Ring> rings, double weld) {
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

}  // namespace

double least_safe_snap(std::span<const Ring> rings) {
  return margins::least_snap * largest_coordinate(box_of(rings));
}

std::optional<CurveDrawing> draw_curves(const CurveInput& input, double snap) {
  Box2 box = box_of(input.rings);
  const double weld = margins::weld_of_size * (box.high - box.low).norm() +
                      margins::weld_of_coordinates * largest_coordinate(box);
  CurveDrawing drawing{SnapGraph(snap), {}, {}};
  add_rings(drawing, input.rings, weld);
  // Wide enough that ends made by clipping stay clear of the rings.
  const double margin = 8 * snap + margins::clip * (box.high - box.low).norm();
  box.low.array() -= margin;
  box.high.array() += margin;
  for (const Segment2& contact : input.contacts)
    if (const auto part = clip(contact, box))
      drawing.graph.add_line((*part)[0], (*part)[1], std::min(weld, snap));
  if (!drawing.graph.settle()) return {};
  drawing.graph.freeze();
  for (const CurvePolyline& curve : input.curves)
    for (std::size_t k = 1; k < curve.points.size(); ++k)
      if (const auto part = clip({curve.points[k - 1], curve.points[k]}, box)) {
        const int edge = drawing.graph.add_line((*part)[0], (*part)[1]);
        if (edge >= 0)
          drawing.pieces.push_back({{curve.points[k - 1], curve.points[k]}, curve.id, edge});
      }
  if (!drawing.graph.settle()) return {};
  return drawing;
}

}  // namespace halfshade
