#pragma once

#include "solver/reflected/reflecting_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// Where a ray meets the front of a triangle.
struct RayEnd {
  int triangle;
  float s, t;  ///< TrianglePlace

  TrianglePlace place() const { return {s, t}; }
};

/// Where rays start.
struct RayOrigin {
  Vec3 position, normal;
  int cell = -1;           ///< rays end in this cell only; −1: anywhere
  bool is_closed = false;  ///< no light leaves the cell
  int plane = -1;          ///< of the soup, that it lies in; −1: none
};

/// Rays over the hemisphere above a point, one in each of strata² parts of equal form factor:
/// points of a square, each alone in its cell and in its strata²-th of rows and of columns (Kensler
/// 2013), taken to the disc below the hemisphere (Shirley and Chiu 1997). The same for equal
/// values.
struct RayHemisphere {
  RayOrigin from;
  int strata;
  std::uint64_t seed;
};

/// What became of the rays of a hemisphere.
struct HemisphereEnds {
  int first, last;  ///< its ends among those of all
  /// The number that an end is one of: backs and the open swallow. In a closed cell that is the
  /// number of ends, so that what rounding loses is made up for.
  int rays;
};

struct TracedHemispheres {
  std::vector<RayEnd> ends;  ///< on fronts of roots
  std::vector<HemisphereEnds> of_each;

  std::span<const RayEnd> ends_of(std::size_t hemisphere) const {
    const auto& [first, last, rays] = of_each[hemisphere];
    return std::span(ends).subspan(at(first), at(last - first));
  }
};

/// The rays of hemispheres above one plane. Those of one element, or of one point, take two thirds
/// of the time if they go together (rays_of_elements in the benchmark): rays that look the same way
/// share a packet.
TracedHemispheres trace_hemispheres(const ReflectingScene& scene,
                                    std::span<const RayHemisphere> hemispheres);

/// One ray from each of some places, in the direction that its point of the unit square stands for
/// as those of hemispheres do. Where no front is met, or one of another cell, the end's triangle is
/// −1. Spans must be equally long; a few thousand rays from one surface go well together.
std::vector<RayEnd> trace_rays(const ReflectingScene& scene, std::span<const RayOrigin> from,
                               std::span<const Vec2> on_square);

}  // namespace halfshade
