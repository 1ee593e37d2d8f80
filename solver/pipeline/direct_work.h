#pragma once

#include "solver/adapt/noisy_field.h"
#include "solver/direct/direct_light.h"
#include "solver/direct/ray_light.h"

namespace halfshade {

/// What direct light has taken so far.
struct DirectWork {
  double places = 0;
  double crowd = 0;  ///< looks at faces and crossings, see DirectLight::crowd_work
  double rays = 0;   ///< to emitters
};

/// As a share of what so many unknowns are worth; 0 if nothing was done.
double work_done(const DirectWork& work, int unknowns);

/// At how many more places so many unknowns are worth it, if these take what others took; 0 or less
/// if at none. Where very many faces lie before emitters, the accuracy asked for may take hours. By
/// default some ten to twenty seconds of exact looks on two cores, and up to a minute of rays in
/// scenes of up to some thousand surfaces.
double places_left(const DirectWork& work, int unknowns);

/// Direct light in W/m²; adds what it takes to `work`. All are referred to.
FieldAt direct_light_at(const SoundScene& scene, const DirectLightIndex& index, DirectWork& work);
NoisyFieldAt direct_light_at(const SoundScene& scene, const RayLight& light, DirectWork& work);

/// Where elements are very many, looks at some of them, for what they take to be known before all
/// are looked at.
void try_middles(const ElementTable& elements, const FieldAt& light, const Progress& progress);

}  // namespace halfshade
