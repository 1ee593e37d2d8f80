#pragma once

#include "meshing/core/light_source.h"
#include "solver/direct/ray_light.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve_options.h"

#include <span>
#include <string>
#include <vector>

namespace halfshade {

/// What a scene needs, decided before the work. Reasons are for the user; empty if nothing is left
/// out.
struct Plan {
  std::string no_discontinuities;     ///< why none are looked for
  std::string no_eee;                 ///< why none at three edges are looked for
  std::string no_exact_direct_light;  ///< why direct light comes out of the matrix
  std::string no_factors;             ///< why no reflected light is solved for
  std::string no_channels;            ///< why one channel does for all three
  std::vector<int> lit;  ///< surfaces that can get a noticeable part of the light, see lit_surfaces
  std::vector<LightSource> sources;  ///< to find discontinuities of; empty without
  std::size_t weak_sources = 0;      ///< left out of them, for they give too little
  RayLightOptions rays;              ///< that look at direct light; without a deviation it is exact
  double mean_irradiance = 0;        ///< what the tolerance is a share of, W/m²; 0 without sources
};

/// Adds the stage "sources" to `stages` unless the scene or the options tell that there is no need
/// of any. Cost: that of mean_direct_irradiance, and of secondary_sources if they are asked for.
Plan make_plan(const PreparedScene& prepared, const SolveOptions& options, const Progress& progress,
               Stages& stages);

/// Why no discontinuities need be looked for, as far as the surfaces that exchange light tell;
/// empty if they do. What lies beyond a wall has no part in it.
std::string discontinuities_needless(const SoundScene& scene, std::span<const int> exchanging,
                                     const SolveOptions& options);

/// Why no curves at three edges need be looked for, if any are: the edges of one convex body, or of
/// one convex polygon, are never three in a line of sight.
std::string eee_needless(const SoundScene& scene, std::span<const int> exchanging,
                         const SolveOptions& options);

/// Why no form factors are needed, with direct light that is exact or not.
std::string factors_needless(const SoundScene& scene, bool is_exact, const SolveOptions& options);

/// Why all channels are the same.
std::string channels_needless(const SoundScene& scene, const SolveOptions& options);

/// Why direct light needs no stage of its own; empty if it does.
std::string direct_light_needless(const SoundScene& scene, DirectLightBy choice);

/// True if each of some surfaces lies in front of every other, as in an empty room: none of them
/// can hide a part of another from anywhere.
bool is_convex(const SoundScene& scene, std::span<const int> ids);

/// The work on finding curves that a tolerance is worth, see DiscontinuityOptions::most_work; 0, no
/// limit, for a tolerance of 0.
double affordable_work(double tolerance);

/// Mean over the surfaces that light reaches straight from emitters of the irradiance it gives
/// them (strongest channel), from one exact value at each of about 2000 places; if all of these are
/// dark, from places that it falls on. Surfaces too far away to get noticeable light do not count.
/// What relative tolerances refer to. W/m²; 0 if nothing is reached.
double mean_direct_irradiance(const PreparedScene& prepared, const Progress& progress = {});

}  // namespace halfshade
