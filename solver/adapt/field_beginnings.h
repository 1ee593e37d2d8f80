#pragma once

#include "solver/adapt/adaptive_field.h"

#include <cstddef>

namespace halfshade {

/// Throws Error(contract) if options of fit_adaptively are out of range.
void require_usable(const AdaptiveFieldOptions& options);

/// The order that most elements begin with: low ones where they will do; what is too high is
/// dropped in the end.
int first_order(const AdaptiveFieldOptions& options);

/// Whether elements of a surface count, see AdaptiveFieldOptions.
inline bool counts(const AdaptiveFieldOptions& options, int surface) {
  return options.counted.empty() || options.counted[at(surface)];
}

/// How many elements count, or all of them if none does; and their area.
struct CountedElements {
  double count = 0, area = 0;

  void operator+=(const CountedElements& other) {
    count += other.count;
    area += other.area;
  }
};
CountedElements counted_elements(const ElementTable& elements, const AdaptiveFieldOptions& options);

/// See AdaptiveFieldOptions.
double samples_left(const AdaptiveFieldOptions& options);

/// The orders that elements begin with: lower ones if they have a small share of the mean area, for
/// most of these matter little, and in clutter there are many; 0 if they do not count. All are
/// lower where samples would be too many.
std::vector<int> beginning_orders(const ElementTable& elements, const CountedElements& all,
                                  const AdaptiveFieldOptions& options);

/// Places evenly spread over a triangle, different for each index (Roberts' sequence).
TrianglePlace spread_place(std::size_t index);

/// Where an element begins in that sequence: no two alike, and what there is besides changes
/// nothing, see triangle_key.
std::size_t first_spread(const std::array<Vec3, 3>& triangle);

}  // namespace halfshade
