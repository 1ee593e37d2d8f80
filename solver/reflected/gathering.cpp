#include "solver/reflected/gathering.h"

namespace halfshade {

GatheredRays gather_rays(const ReflectingScene& scene, const FirstLight& light, Looks looks,
                         std::span<const RayHemisphere> hemispheres) {
  const auto leaving = [&light](int root, const Vec3& p) { return light.leaving(root, p); };
  GatheredRays rays{trace_hemispheres(scene, hemispheres), {}};
  rays.first = light.hot.irradiance(scene, leaving, looks, hemispheres, rays.traced);
  return rays;
}

void settle(const TriangleForest& forest, TracedHemispheres& traced) {
  for (RayEnd& end : traced.ends) {
    if (forest.is_leaf(end.triangle)) continue;
    const ForestPlace leaf = forest.leaf_at({end.triangle, end.place()});
    end = {leaf.triangle, static_cast<float>(leaf.place.x()), static_cast<float>(leaf.place.y())};
  }
}

ChannelArray irradiance(const TracedHemispheres& traced, const LeavingField& leaving) {
  constexpr std::size_t ahead = 8;
  ChannelArray values(static_cast<Eigen::Index>(traced.of_each.size()), 3);
  Eigen::Index h = 0;
  for (const auto& [first, last, rays] : traced.of_each) {
    Rgb sum = Rgb::Zero();
    for (std::size_t i = at(first); i < at(last); ++i) {
      if (i + ahead < traced.ends.size()) leaving.prefetch(traced.ends[i + ahead].triangle);
      sum += leaving.value(traced.ends[i].triangle, traced.ends[i].place());
    }
    values.row(h++) = (sum / rays).transpose();
  }
  return values;
}

ChannelArray gathered(GatheredRays rays, const TriangleForest& forest,
                      const LeavingField& leaving) {
  settle(forest, rays.traced);
  return rays.first + irradiance(rays.traced, leaving);
}

std::size_t rays_of_hemisphere(const FirstLight& light, int strata) {
  return at(strata * strata + light.hot.count(strata * strata));
}

}  // namespace halfshade
