#pragma once

#include "meshing/arrangement/arrangement.h"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace halfshade {

/// Closed polygons of a plane laid over each other, as a triangulation in which every triangle is
/// covered evenly.
struct Overlay {
  std::vector<Vec2> points;  ///< the given ones first, then crossings
  HullTriangulation hull;
  /// One a triangle: (loop, winding number) for every loop that winds round it, by loop. A loop is
  /// sound if its winding number is 1 wherever it is not 0.
  std::vector<std::vector<std::pair<int, int>>> winding;
};

/// Lays loops of points over each other; `snap` as in arrange(), but where sides would cross all
/// the same points become one within the radius of links. Deterministic.
Overlay overlay(std::vector<Vec2> points, std::span<const std::vector<int>> loops,
                const SnapRadii& snap);

/// The loops that wind round a place more than once or the wrong way, other than in slivers thinner
/// than `width`: those that cross themselves. Sorted.
std::vector<int> crossed_loops(const Overlay& overlay, double width);

/// A part of an overlay that is connected across edges.
struct OverlayRegion {
  int label = 0;
  std::vector<int> triangles;
  /// The outer boundary (counter-clockwise), then the holes (clockwise), as points of the overlay.
  /// No ring visits a point twice; a hole may touch another ring in a point.
  std::vector<std::vector<int>> rings;
};

/// The regions of equal label, by first triangle; triangles with a negative label are left out.
std::vector<OverlayRegion> regions(const Overlay& overlay, std::span<const int> labels);

/// Twice the signed area of a closed polygon.
double twice_area(std::span<const Vec2> points, std::span<const int> loop);

}  // namespace halfshade
