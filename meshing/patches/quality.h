#pragma once

#include "meshing/patches/element_table.h"

#include <array>
#include <cstddef>
#include <vector>

namespace halfshade {

/// Smallest angle of a triangle in degrees, in [0, 60]; 0 for one without area.
double min_angle_degrees(const std::array<Vec3, 3>& triangle);

/// The smallest angle of every element, in degrees.
std::vector<double> min_angles(const ElementTable& elements);

struct QualitySummary {
  int worst_element = -1;   ///< the first with the smallest angle; −1 if there are no elements
  double min_angle = 0;     ///< its angle, degrees
  double mean_angle = 0;    ///< mean over elements of their smallest angle, degrees
  double longest_edge = 0;  ///< scene units
  std::array<std::size_t, 12> histogram{};  ///< elements by smallest angle, in bins of 5 degrees
};

QualitySummary summarize_quality(const ElementTable& elements);

/// Which elements have a corner at which two constrained edges (edge_order ≥ 0), with the element
/// or others between them, meet at less than 60 degrees: there no mesh can have good angles.
std::vector<bool> at_input_angles(const ElementTable& elements);

/// Smallest angles by area, as shares of the whole area.
struct AreaQuality {
  std::array<double, 12> histogram{};  ///< by smallest angle, in bins of 5 degrees
  double near_input_angles = 0;        ///< elements at input angles (see above)
  /// The others, as shares of their area (1 if there are none): those whose smallest angle is at
  /// least delaunay_angle and at least 1 degree.
  double good = 1, tolerable = 1;
  double min_angle = 60;  ///< the smallest among the others, degrees
};

AreaQuality summarize_area_quality(const ElementTable& elements);

}  // namespace halfshade
