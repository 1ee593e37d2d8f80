#pragma once

#include <cstdint>
#include <span>

namespace halfshade {

/// How one of the emitters that a point may see is looked at.
enum class RayWay : std::uint8_t {
  own,    ///< by rays of its own
  drawn,  ///< by those of the rays for all such emitters that happen to be drawn for it
  exact   ///< its visible part is looked for
};

struct RayShare {
  double strength = 0;  ///< what it gives if nothing is in between, in deviations allowed; > 0
  RayWay way = RayWay::own;
  int rays = 0;  ///< of its own, for one of two estimates
};

/// Rays for all emitters that are drawn.
struct DrawnRays {
  double strength = 0;  ///< of all of them
  int rays = 0;         ///< for one of two estimates; each stands for as much light as any other
};

/// The fewest rays in all with which the variances of a mean of two estimates sum to one, about.
/// Those that are `exact` or `drawn` stay so, others become so where that takes less: exact if rays
/// of their own were more than `most_rays`, drawn if they are weak and many. Which ones are drawn
/// does not hang on the rounding of what is equally strong.
DrawnRays share_rays(std::span<RayShare> shares, double most_rays);

}  // namespace halfshade
