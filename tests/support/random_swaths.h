#pragma once

#include "meshing/events/swath.h"
#include "tests/support/sound_scenes.h"

#include <array>
#include <utility>

namespace halfshade::test {

/// Of a light at z = 2 that looks down.
inline const PlaneFrame emitter = make_frame({0, 0, 2}, -Vec3::UnitZ());

inline Vec3 in_room(Random& random) { return random.in_box({-1, -1, 0.1}, {1, 1, 1.9}); }

inline Span3 random_span(Random& random) { return {in_room(random), in_room(random)}; }

inline Swath random_fan(Random& random) {
  Swath swath;
  swath.apex = in_room(random);
  swath.base = random_span(random);
  return swath;
}

/// Three skew edges that a line through the light's plane meets well inside them.
inline Swath random_ruled(Random& random) {
  const Vec3 foot = random.in_box({-0.5, -0.5, 0}, {0.5, 0.5, 0});
  const Vec3 along = Vec3(random(-0.4, 0.4), random(-0.4, 0.4), 1);
  std::array<Span3, 3> edges;
  double height = 0.1;
  for (Span3& edge : edges) {
    height += random(0.15, 0.5);
    const Vec3 span = random(0.4, 1.5) * (random.direction() + Vec3(0, 0, 0.1));
    edge.from = foot + height * along - random(0.1, 0.9) * span;
    edge.to = edge.from + span;
  }
  std::swap(edges[0], edges[static_cast<std::size_t>(random.integer(0, 2))]);
  Swath swath;
  set_edges(swath, edges);
  return swath;
}

/// A fan whose lines must meet an edge in its plane, too.
inline Swath random_fan_of_two(Random& random) {
  Swath swath = random_fan(random);
  const auto in_fan = [&]() -> Vec3 {
    return swath.apex + random(0.2, 2) * (swath.base.at(random(-0.2, 1.2)) - swath.apex);
  };
  swath.second = {in_fan(), in_fan()};
  return swath;
}

inline Swath random_swath(Random& random) {
  switch (random.integer(0, 3)) {
    case 0:
      return random_fan(random);
    case 1:
      return random_fan_of_two(random);
    default:
      return random_ruled(random);
  }
}

}  // namespace halfshade::test
