#pragma once

#include "meshing/element_table.h"

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

}  // namespace halfshade
