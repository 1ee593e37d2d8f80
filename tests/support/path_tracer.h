#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/rays/visibility.h"
#include "solver/direct/direct_light.h"
#include "tests/support/random.h"

#include <cmath>

/// Reflected light by random walks, independent of every mesh of elements.
namespace halfshade::test {

struct TracedLight {
  Rgb mean = Rgb::Zero();
  Rgb variance = Rgb::Zero();  ///< of the mean, at most
};

class PathTracer {
 public:
  explicit PathTracer(const SoundScene& scene)
      : scene_(scene), direct_(scene), visibility_(occluders(scene)) {}

  const DirectLightIndex& direct() const { return direct_; }

  /// Irradiance after 1 … bounces reflections, by strata² walks whose first directions are
  /// stratified. Neighbouring strata tell the variance.
  TracedLight reflected(const SurfacePoint& point, int strata, int bounces, Random& random) const {
    TracedLight result;
    Rgb last = Rgb::Zero();
    for (int i = 0; i < strata; ++i)
      for (int j = 0; j < strata; ++j) {
        const double u = (i + random(0, 1)) / strata, v = (j + random(0, 1)) / strata;
        const Rgb value = walk(point, u, v, bounces, random);
        result.mean += value;
        if (j % 2 == 1) result.variance += (value - last).square();
        last = value;
      }
    const double n = strata * strata;
    result.mean /= n;
    result.variance /= n * n;
    return result;
  }

 private:
  Rgb walk(SurfacePoint from, double u, double v, int bounces, Random& random) const {
    Rgb sum = Rgb::Zero(), weight = Rgb::Ones();
    for (int k = 0; k < bounces; ++k) {
      const PlaneFrame frame = make_frame(from.position, from.normal);
      const double r = std::sqrt(u), angle = 2 * M_PI * v;
      const Vec3 way = r * std::cos(angle) * frame.e1 + r * std::sin(angle) * frame.e2 +
                       std::sqrt(1 - u) * frame.normal;
      const auto hit = visibility_.first_hit(from.position, way);
      if (!hit) return sum;
      const Surface& surface = scene_.surfaces[at(hit->owner)];
      const Material& material = scene_.materials[at(surface.material)];
      Vec3 normal = surface.frame.normal;
      if (normal.dot(way) >= 0) {
        if (!material.two_sided) return sum;
        normal = -normal;
      }
      weight *= material.rho;
      if ((weight == 0).all()) return sum;
      const Vec3 end = from.position + hit->distance * way;
      from = {end - surface.frame.height(end) * surface.frame.normal, normal};
      sum += weight * direct_.irradiance(from).irradiance;
      u = random(0, 1);
      v = random(0, 1);
    }
    return sum;
  }

  const SoundScene& scene_;
  DirectLightIndex direct_;
  VisibilityIndex visibility_;
};

}  // namespace halfshade::test
