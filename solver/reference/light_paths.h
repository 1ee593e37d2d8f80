#pragma once

#include "meshing/rays/visibility.h"
#include "solver/reference/emitter_samples.h"
#include "solver/reference/reference_light.h"
#include "solver/reference/sample_sequence.h"

#include <optional>

namespace halfshade {

/// What a camera's ray meets.
struct SeenPlace {
  ReferencePoint point;
  int surface = 0;
};

/// Traces single paths through a scene. All calls may run concurrently.
class LightPaths {
 public:
  /// The scene must outlive it.
  explicit LightPaths(const SoundScene& scene);

  /// What one path from a point finds: its mean over all samples is the irradiance. `bounces` as in
  /// ReferenceOptions. Throws Error(invalid_input) if the path does not end.
  ArrivingLight trace(const ReferencePoint& point, int bounces, const SampleNumbers& numbers) const;

  /// The first front along a ray of unit direction: backs are not seen, so that a room can be
  /// looked into from outside. Nothing if there is none.
  std::optional<SeenPlace> seen(const Vec3& origin, const Vec3& direction) const;

 private:
  struct End;

  std::optional<End> next_end(const End& from, const Vec3& direction) const;
  Rgb from_emitters(const End& to, int bounce, const SampleNumbers& numbers) const;
  Rgb from_ahead(const End& to, const End& from, const Vec3& direction) const;
  const Material& material(const End& end) const;

  const SoundScene& scene_;
  VisibilityIndex visibility_;
  EmitterSamples emitters_;
};

}  // namespace halfshade
