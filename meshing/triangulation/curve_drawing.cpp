#include "meshing/triangulation/curve_drawing.h"

#include "meshing/arrangement/arrangement.h"
#include "meshing/arrangement/triangles_inside.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace halfshade {
namespace {

// Lines are clipped to a box that is wider than the rings' by this share of its size.
constexpr double clip_margin = 1e-3;

// Corners of rings closer than this are one; of their size, and of their largest coordinate.
constexpr double weld_of_size = 1e-13, weld_of_coordinates = 32 * 0x1p-53;
// Snap distances of at least this many roundings of the largest coordinate make safe decisions.
constexpr double least_snap = 256 * 0x1p-53;
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
  return least_snap * largest_coordinate(box_of(rings));
}

std::optional<CurveDrawing> draw_curves(const CurveInput& input, double snap) {
  Box2 box = box_of(input.rings);
  const double weld =
      weld_of_size * (box.high - box.low).norm() + weld_of_coordinates * largest_coordinate(box);
  CurveDrawing drawing{SnapGraph(snap), {}, {}};
  add_rings(drawing, input.rings, weld);
  // Wide enough that ends made by clipping stay clear of the rings.
  const double margin = 8 * snap + clip_margin * (box.high - box.low).norm();
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

}  // namespace halfshade
