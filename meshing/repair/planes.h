#pragma once

#include "meshing/core/plane_frame.h"
#include "meshing/core/tolerance.h"

#include <span>
#include <vector>

namespace halfshade {

/// Vertices that are the same point, found once.
struct WeldedVertices {
  std::vector<Vec3> points;
  std::vector<int> of_vertex;  ///< vertex → point; −1 for vertices no face uses
};

/// Welds vertices closer together than the tolerance: each becomes the first one near it.
WeldedVertices weld(const Scene& scene, const Tolerance& tolerance);

/// The distinct planes of polygons.
struct PlaneClasses {
  std::vector<PlaneFrame> frames;  ///< one a plane
  std::vector<int> of_polygon;     ///< polygon → plane
};

/// Sorts planar polygons (loops of points, with an area) into planes, whichever way they look.
/// Deterministic; each polygon is compared with few planes only.
PlaneClasses classify_planes(std::span<const Vec3> points, std::span<const std::vector<int>> loops,
                             const Tolerance& tolerance);

}  // namespace halfshade
