#pragma once

#include "solver/factors/sight_scene.h"

#include <span>

namespace halfshade {

/// Whether one convex polygon or body, of those that some triangles of SightScene::between are
/// sides of, hides all of two convex polygons from each other. With too many triangles false.
bool hides_all(const SightScene& scene, const Between& triangles, std::span<const Vec3> part,
               std::span<const Vec3> other);

/// Whether each triangle is parted from two polygons by the plane of some blocker among them, so
/// that none reaches into their hull. Quicker than a shaft where there are few.
bool are_all_beside(const SightScene& scene, const Between& triangles, std::span<const Vec3> part,
                    std::span<const Vec3> other);

}  // namespace halfshade
