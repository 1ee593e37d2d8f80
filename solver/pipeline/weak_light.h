#pragma once

#include "solver/adapt/adaptive_field.h"
#include "solver/pipeline/prepared_scene.h"

#include <cstddef>
#include <span>
#include <vector>

namespace halfshade {

/// Direct light where many emitters shine over many surfaces. What a point sees of an emitter takes
/// some 0.1 ms to find among thousands of surfaces: it is found of the emitters that matter there.
/// Of the others a few shadow rays tell which share is seen, so few and weak ones that their noise
/// at the point has a standard deviation below a bound. The noise is in the samples, and so in
/// every estimate that is made of them. The same for the same points.
class WeakLight {
 public:
  /// `noise` is the bound, W/m², of the channels together. The scene must outlive it.
  WeakLight(const PreparedScene& prepared, double noise);

  struct Light {
    Rgb irradiance = Rgb::Zero();
    std::size_t crowd_work = 0;  ///< see DirectLight
  };
  Light irradiance(const FieldPoint& point) const;

 private:
  struct Emitter {
    int surface;
    Rgb exitance;
    std::vector<std::vector<Vec3>> rings;
    std::vector<std::vector<Vec3>> places;  ///< several times, evenly spread over it
  };
  struct Share {
    const Emitter* emitter;
    double factor;  ///< form factor, if nothing were in between
    double size;    ///< of its light then
  };
  std::vector<Share> shares(const SurfacePoint& point) const;
  bool add_by_rays(const FieldPoint& point, const Share& share, std::size_t pattern,
                   Rgb& light) const;

  const PreparedScene& prepared_;
  double noise_;
  std::vector<Emitter> emitters_;
};

/// Whether WeakLight is worth while: many surfaces, and more than one emitter.
bool has_weak_light(const SoundScene& scene);

}  // namespace halfshade
