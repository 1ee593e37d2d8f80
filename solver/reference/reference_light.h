#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// A place that light arrives at.
struct ReferencePoint {
  Vec3 position;
  Vec3 normal;  ///< unit length; light from behind it does not count
};

/// Irradiance in W/m², or its standard error.
struct ArrivingLight {
  Rgb direct = Rgb::Zero();     ///< straight from the emitters
  Rgb reflected = Rgb::Zero();  ///< after at least one reflection
  Rgb total = Rgb::Zero();      ///< both
};

/// A triangle that light arrives at; its front sees its corners counter-clockwise.
using ReferenceTriangle = std::array<Vec3, 3>;

struct ReferenceOptions {
  int samples =
      1024;  ///< paths from a point or triangle, ≥ 1; rounded up to `batches` times a power of two
  int batches = 32;         ///< ≥ 2, independent of each other: they tell the standard error
  int bounces = -1;         ///< −1: all; n ≥ 0: light that arrives after at most n reflections
  std::uint64_t seed = 0;   ///< others give independent results
  std::uint64_t first = 0;  ///< number of the first one, for lists that are worked on in parts
};

struct ReferenceLight {
  std::vector<ArrivingLight> values;           ///< one a point or triangle
  std::vector<ArrivingLight> standard_errors;  ///< of `values`
  int samples = 0;                             ///< from each
  int batches = 0;
  /// False if stopped: values of those that were not reached are 0, with a standard error of 0.
  bool complete = true;
};

/// Irradiance at points by tracing paths (Kajiya 1986): from each end one ray to a random point of
/// the emitters and one ahead, joined by the balance heuristic (Veach and Guibas 1995), so that no
/// path counts for more than the brightest emitter; paths end by Russian roulette, without bias.
/// It shares scene and rays with the rest of halfshade and nothing else, to check the rest against.
/// Errors fall a little faster than the square root of `samples`. A value divided by its standard
/// error follows Student's distribution with batches − 1 degrees of freedom, as far as the means of
/// batches are normal: where light comes from few paths (a small emitter seen only by reflection)
/// it takes more samples.
/// On all threads; what a point gets depends on its number, and not on that of the threads.
/// About 1 µs a ray, two a bounce. Throws Error(contract) for options out of range, and
/// Error(invalid_input) where light is never absorbed.
ReferenceLight reference_light(const SoundScene& scene, std::span<const ReferencePoint> points,
                               const ReferenceOptions& options, const Progress& progress = {});

/// Mean irradiance over triangles, as elements have it: the same from random points of each, spread
/// evenly over it. Throws Error(contract), for triangles without an area, too.
ReferenceLight reference_means(const SoundScene& scene,
                               std::span<const ReferenceTriangle> triangles,
                               const ReferenceOptions& options, const Progress& progress = {});

}  // namespace halfshade
