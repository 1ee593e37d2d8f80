#include "solver/reference/classic_picture.h"

#include "meshing/core/error.h"
#include "solver/reference/light_paths.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

constexpr double pi = std::numbers::pi;

Vec3 mirrored(const Vec3& direction, const Vec3& normal) {
  return direction - 2 * direction.dot(normal) * normal;
}

/// The middle of a surface's triangles, by area.
Vec3 centre_of(const TriangleSoup& soup, int surface) {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    if (soup.owner[t] != surface) continue;
    const auto& [a, b, c] = soup.triangles[t];
    const Vec3 &p = soup.points[at(a)], &q = soup.points[at(b)], &r = soup.points[at(c)];
    const double part = (q - p).cross(r - p).norm() / 2;
    sum += part * (p + q + r) / 3;
    area += part;
  }
  return area > 0 ? Vec3(sum / area) : sum;
}

/// Light at one place on its way to the eye.
struct Shading {
  Vec3 position, normal, to_eye;
  int plane = -1;
};

class LocalIllumination {
 public:
  LocalIllumination(const SoundScene& scene, const ClassicOptions& options)
      : scene_(scene),
        options_(options),
        paths_(scene),
        visibility_(surface_triangles(scene)),
        emitters_(scene, visibility_.soup()),
        ambient_(options.ambient < 0 ? evenly_spread_light(scene)
                                     : Rgb::Constant(options.ambient)) {
    for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s)
      if ((material(s).exitance > 0).any())
        centres_.push_back({centre_of(visibility_.soup(), s), s, 1 / area(scene.surfaces[at(s)])});
  }

  SeenLight look(Vec3 origin, Vec3 direction, const SampleNumbers& numbers) const {
    SeenLight light;
    for (int mirrors = 0; mirrors <= options_.most_mirrors; ++mirrors) {
      const auto seen = paths_.seen(origin, direction);
      if (!seen) return light;
      if (at(seen->surface) < options_.mirrors.size() && options_.mirrors[at(seen->surface)]) {
        origin = seen->point.position;
        direction = mirrored(direction, seen->point.normal);
        continue;
      }
      light.emits = mirrors == 0 && (material(seen->surface).exitance > 0).any();
      light.radiance = leaving(*seen, direction, numbers);
      return light;
    }
    return light;
  }

 private:
  const Material& material(int surface) const {
    return scene_.materials[at(scene_.surfaces[at(surface)].material)];
  }

  Rgb leaving(const SeenPlace& seen, const Vec3& direction, const SampleNumbers& numbers) const {
    const Material& m = material(seen.surface);
    const Shading place{seen.point.position, seen.point.normal, -direction,
                        scene_.surfaces[at(seen.surface)].plane};
    const Rgb rho = reflectance_at(scene_, scene_.surfaces[at(seen.surface)], place.position);
    Rgb radiance = (m.exitance + rho * ambient_) / pi;
    const auto add = [&](const EmitterPoint& from) { radiance += shaded_by(from, place, rho); };
    if (options_.shadows == ClassicShadows::soft) {
      if (const auto from = emitters_.point(numbers.pair(0))) add(*from);
    } else {
      for (const EmitterPoint& from : centres_) add(from);
    }
    return radiance;
  }

  Rgb shaded_by(const EmitterPoint& from, const Shading& place, const Rgb& rho) const {
    const Surface& emitter = scene_.surfaces[at(from.surface)];
    const Vec3 way = from.position - place.position;
    const double r = way.norm();
    const double here = place.normal.dot(way), there = -emitter.frame.normal.dot(way);
    if (!(here > 0 && there > 0)) return Rgb::Zero();
    if (options_.shadows != ClassicShadows::none &&
        visibility_.blocked(Segment{place.position, from.position, place.plane, emitter.plane}))
      return Rgb::Zero();
    const Rgb irradiance =
        material(from.surface).exitance * (here * there / (pi * r * r * r * r * from.density));
    // The lobe of Phong's cosine holds (n + 2) / 2π times the irradiance at its tip.
    const double cosine = std::max(0., mirrored(-way / r, place.normal).dot(place.to_eye));
    const double lobe = options_.highlight * (options_.exponent + 2) / (2 * pi) *
                        std::pow(cosine, options_.exponent);
    return irradiance * (rho / pi + lobe);
  }

  const SoundScene& scene_;
  const ClassicOptions& options_;
  LightPaths paths_;
  VisibilityIndex visibility_;
  EmitterSamples emitters_;
  Rgb ambient_;
  std::vector<EmitterPoint> centres_;
};

}  // namespace

Rgb evenly_spread_light(const SoundScene& scene) {
  Rgb power = Rgb::Zero(), reflecting = Rgb::Zero();
  double all = 0;
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials[at(surface.material)];
    const double own = area(surface);
    all += own;
    power += own * material.exitance;
    Rgb rho = material.rho;
    if (surface.paint >= 0)  // as if all of the picture were seen
      rho *= scene.paints[at(surface.paint)].texture->levels.back().texels[0].cast<double>();
    reflecting += own * rho;
  }
  if (!(all > 0)) return Rgb::Zero();
  const Rgb rho = reflecting / all;
  return (rho < 1).select(power / all * rho / (1 - rho), Rgb::Zero());
}

TracedPicture classic_picture(const SoundScene& scene, const CameraRays& camera,
                              const ClassicOptions& options, const PixelOptions& pixels,
                              const Progress& progress) {
  if (!(options.highlight >= 0) || !(options.exponent >= 1) || options.most_mirrors < 0)
    throw Error(ErrorCode::contract, "classic_picture",
                fmt::format("highlight {}, exponent {} or {} mirrors are out of range",
                            options.highlight, options.exponent, options.most_mirrors));
  const LocalIllumination light(scene, options);
  return trace_pixels(
      camera, pixels,
      [&](const Vec3& origin, const Vec3& direction, const SampleNumbers& numbers) -> SeenLight {
        return light.look(origin, direction, numbers);
      },
      progress);
}

}  // namespace halfshade
