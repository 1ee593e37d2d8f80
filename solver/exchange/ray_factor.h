#pragma once

#include "meshing/core/types.h"
#include "meshing/rays/visibility.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace halfshade {

/// What ray_visibility needs to know of one end of a pair.
struct PairEnd {
  std::array<Vec3, 3> triangle;
  Vec3 normal;  ///< unit length
  int plane;    ///< see Segment
};

/// Estimates which part of the light exchanged by two triangles gets through: rays between points
/// of a low-discrepancy sequence, each weighted with the exchange kernel cos·cos/r², so that near
/// pairs are not biased towards their far parts. In [0, 1]. Deterministic for equal arguments.
/// Holds its buffers between calls; one a thread.
class RayVisibility {
 public:
  explicit RayVisibility(const VisibilityIndex& visibility) : visibility_(&visibility) {}

  /// `seed` decorrelates pairs; `rays` ≥ 1.
  double visible_fraction(const PairEnd& a, const PairEnd& b, int rays, std::uint64_t seed);

 private:
  const VisibilityIndex* visibility_;
  std::vector<Segment> segments_;
  std::vector<double> weights_;
  std::vector<std::uint8_t> blocked_;
};

}  // namespace halfshade
