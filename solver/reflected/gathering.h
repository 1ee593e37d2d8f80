#pragma once

#include "solver/reflected/first_light.h"
#include "solver/reflected/hemisphere_rays.h"
#include "solver/reflected/leaving_field.h"

#include <span>

namespace halfshade {

/// Hemispheres of rays, and what comes from where they end, and from hot cells, first: irradiance
/// from S, one row a hemisphere.
struct GatheredRays {
  TracedHemispheres traced;
  ChannelArray first;
};

/// Precondition: all hemispheres are above the same plane, and have the same strata.
GatheredRays gather_rays(const ReflectingScene& scene, const FirstLight& light, Looks looks,
                         std::span<const RayHemisphere> hemispheres);

/// Takes ends on triangles that were bisected to the leaves there.
void settle(const TriangleForest& forest, TracedHemispheres& traced);

/// Irradiance from a field on the leaves where the rays end, one row a hemisphere.
ChannelArray irradiance(const TracedHemispheres& traced, const LeavingField& leaving);

/// The same from S and from a field.
ChannelArray gathered(GatheredRays rays, const TriangleForest& forest, const LeavingField& leaving);

/// How many rays a hemisphere takes, with those aimed at hot cells.
std::size_t rays_of_hemisphere(const FirstLight& light, int strata);

}  // namespace halfshade
