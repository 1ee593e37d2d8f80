#include "meshing/geometry/collinear.h"

#include "meshing/core/planar.h"
#include "meshing/core/rounded.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace halfshade {

namespace {

constexpr double shortest = 8;  // tolerances
/// Distances are compared in so many parts of the tolerance.
constexpr double parts = 0x1p20;

/// Lines found so far, by their height over the left (or lower) side of the box of all segments.
/// Steep lines are kept with x and y exchanged; those at about 45°, both ways, so that no segment
/// has to look for lines near it in two places.
class Lines {
 public:
  Lines(std::span<const std::array<Vec2, 2>> segments, double tolerance)
      : segments_(segments), tolerance_(tolerance) {
    for (const auto& [a, b] : segments) box_.extend(a).extend(b);
  }

  /// The nearest line that both ends of a segment are within the tolerance of, or −1.
  int find(int segment) const {
    const Vec2 d = direction(segment).cwiseAbs();
    const int axis = d.x() >= d.y() ? 0 : 1;
    // Near lines have slopes below 2; heights that differ by √5 tolerances at both ends differ by
    // this at the side of the box.
    const double window = std::sqrt(5.0) * tolerance_ * (1 + 2 * box_.sizes()[axis] / d[axis]);
    const auto& sorted = by_height_[static_cast<std::size_t>(axis)];
    const double height = height_at_side(segment, axis);
    int best = -1;
    double least = 1;  // tolerances
    for (auto i = sorted.lower_bound(height - window);
         i != sorted.end() && i->first <= height + window; ++i) {
      // Nearer by rounding is not nearer.
      const double off = std::floor(distance(segment, i->second) / tolerance_ * parts) / parts;
      if (off < least || (off == least && (best < 0 || i->second < best))) {
        best = i->second;
        least = off;
      }
    }
    return best;
  }

  void add(int segment) {
    const Vec2 d = direction(segment).cwiseAbs();
    for (int axis = 0; axis < 2; ++axis)
      if (d[1 - axis] <= 2 * d[axis])
        by_height_[static_cast<std::size_t>(axis)].emplace(height_at_side(segment, axis), segment);
  }

 private:
  const std::array<Vec2, 2>& ends(int segment) const {
    return segments_[static_cast<std::size_t>(segment)];
  }
  Vec2 direction(int segment) const { return ends(segment)[1] - ends(segment)[0]; }

  double height_at_side(int segment, int axis) const {
    const Vec2& a = ends(segment)[0];
    const Vec2 d = direction(segment);
    return a[1 - axis] + d[1 - axis] / d[axis] * (box_.min()[axis] - a[axis]);
  }

  /// Of the ends of a segment from the line through another.
  double distance(int segment, int line) const {
    const Vec2 d = direction(line).normalized();
    const Vec2& origin = ends(line)[0];
    return std::max(std::abs(cross_2d(d, ends(segment)[0] - origin)),
                    std::abs(cross_2d(d, ends(segment)[1] - origin)));
  }

  std::span<const std::array<Vec2, 2>> segments_;
  double tolerance_;
  Eigen::AlignedBox2d box_;
  std::array<std::multimap<double, int>, 2> by_height_;
};

}  // namespace

std::vector<int> collinear_groups(std::span<const std::array<Vec2, 2>> segments, double tolerance) {
  std::vector<int> group(segments.size());
  std::iota(group.begin(), group.end(), 0);
  std::vector<double> lengths;
  for (const auto& [a, b] : segments) lengths.push_back(rounded((b - a).norm()));
  const auto length = [&](int i) { return lengths[static_cast<std::size_t>(i)]; };
  // Longest first: a line is best known by its longest segment.
  std::vector<int> order = group;
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return length(i) > length(j); });
  Lines lines(segments, tolerance);
  for (const int i : order) {
    if (length(i) < shortest * tolerance) break;
    const int line = lines.find(i);
    if (line >= 0)
      group[static_cast<std::size_t>(i)] = line;
    else
      lines.add(i);
  }
  return group;
}

}  // namespace halfshade
