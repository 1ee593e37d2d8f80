#include "meshing/repair/intersections.h"

#include "meshing/core/error.h"
#include "meshing/geometry/flat_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

using Stretch = std::array<double, 2>;

// The sine of the angle between planes below which they have no common line worth speaking of.
constexpr double parallel = 1e-9;

// What takes some seconds to find, and far longer to make use of.
constexpr double most_lines = 500'000;

bool lies_on_both_sides(const SurfaceDraft& draft, const PlaneFrame& plane,
                        const std::vector<Vec3>& points, double slack) {
  bool above = false, below = false;
  for (const int p : draft.rings[0]) {
    const double height = plane.height(points[at(p)]);
    above = above || height > slack;
    below = below || height < -slack;
  }
  return above && below;
}

/// Where a line in a draft's plane runs inside it: parameters in order.
std::vector<Stretch> stretches(const SurfaceDraft& draft, const PlaneFrame& other,
                               const Vec3& along, const std::vector<Vec3>& points) {
  std::vector<double> hits;
  for (const auto& ring : draft.rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec3 &a = points[at(ring[k])], &b = points[at(ring[(k + 1) % ring.size()])];
      const double ha = other.height(a), hb = other.height(b);
      if ((ha > 0) == (hb > 0)) continue;
      hits.push_back(along.dot(a + ha / (ha - hb) * (b - a)));
    }
  std::sort(hits.begin(), hits.end());
  std::vector<Stretch> result;
  for (std::size_t k = 1; k < hits.size(); k += 2) result.push_back({hits[k - 1], hits[k]});
  return result;
}

Bounds box_of(const SurfaceDraft& draft, const std::vector<Vec3>& points) {
  Bounds box;
  for (const int p : draft.rings[0]) box.include(points[at(p)]);
  return box;
}

}  // namespace

std::vector<std::vector<std::array<int, 2>>> find_intersections(
    const std::vector<SurfaceDraft>& drafts, std::vector<Vec3>& points, double most) {
  most = std::min(most, most_lines);
  const std::size_t point_count = points.size();
  std::vector<Bounds> boxes;
  for (const SurfaceDraft& draft : drafts) boxes.push_back(box_of(draft, points));
  const FlatTree tree = make_flat_tree(boxes, 1);
  std::vector<std::vector<std::array<int, 2>>> found(drafts.size());
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    std::vector<int> near;
    visit_overlaps(tree, boxes[i], [&](int j) {
      if (at(j) > i) near.push_back(j);
    });
    std::sort(near.begin(), near.end());
    for (const int j : near) {
      const SurfaceDraft &a = drafts[i], &b = drafts[at(j)];
      const Vec3 line = a.frame.normal.cross(b.frame.normal);
      const LocalTolerance tolerance = tolerance_of(joint_scale(a.scale, b.scale));
      if (a.plane == b.plane || !(line.norm() > parallel) ||
          !lies_on_both_sides(a, b.frame, points, tolerance.planarity) ||
          !lies_on_both_sides(b, a.frame, points, tolerance.planarity))
        continue;
      if (static_cast<double>(points.size() - point_count) > 2 * most)
        throw Error(
            ErrorCode::too_large, {},
            fmt::format("the {} surfaces cut through each other along more than {:.0f} lines",
                        drafts.size(), most));
      const Vec3 along = line.normalized();
      // The point of both planes nearest to the origin of the first.
      const Vec3 down = along.cross(a.frame.normal);
      const Vec3 origin =
          a.frame.origin - b.frame.height(a.frame.origin) / b.frame.normal.dot(down) * down;
      const double start = along.dot(origin);
      for (const Stretch& s : stretches(a, b.frame, along, points))
        for (const Stretch& t : stretches(b, a.frame, along, points)) {
          const double from = std::max(s[0], t[0]), to = std::min(s[1], t[1]);
          if (!(to - from > tolerance.planarity)) continue;
          const int first = static_cast<int>(points.size());
          points.push_back(origin + (from - start) * along);
          points.push_back(origin + (to - start) * along);
          found[i].push_back({first, first + 1});
          found[at(j)].push_back({first, first + 1});
        }
    }
  }
  return found;
}

}  // namespace halfshade
